// Writes a draft as one word of an address, and reads it. '!' separates fields, '_' separates points, and '~' separates
// the value of a point from its color or opacity.

import { Rgba } from '../wire/color_tables';
import { ColorPoint, Draft, OpacityPoint, mostPoints, roundedPerKm, roundedValue } from './draft';
import { colorOfHex, hexOf, knownMoments } from './table_file';

const mostLetters = 8000;

const bareHex = (color: Rgba): string => hexOf(color).slice(1);

export function textOfDraft(draft: Draft): string {
    return [
        draft.moment,
        draft.name.replace(/[^\w.-]/g, '-'),
        draft.isStepped ? 'classes' : 'blend',
        draft.barBegin,
        draft.end,
        bareHex(draft.rangeFolded),
        draft.colors.map(({ value, color }) => `${value}~${bareHex(color)}`).join('_'),
        draft.opacity?.map(({ value, perKm }) => `${value}~${perKm}`).join('_') ?? '',
    ].join('!');
}

function pairs<T>(text: string, read: (value: number, word: string) => T | null): T[] | null {
    const points = text.split('_').map((point) => {
        const [value, word] = point.split('~');
        const number = value === '' || value === undefined ? NaN : Number(value);
        return Number.isFinite(number) && word !== undefined ? read(roundedValue(number), word) : null;
    });
    return points.length <= mostPoints && points.every((point): point is T => point !== null) ? points : null;
}

function rises(points: { value: number }[], mayRepeat: boolean): boolean {
    return points.every((point, i) => {
        const [before, twoBefore] = [points[i - 1], points[i - 2]];
        if (!before || before.value < point.value) return true;
        return mayRepeat && before.value === point.value && twoBefore?.value !== point.value;
    });
}

const colorPoint = (value: number, word: string): ColorPoint | null => {
    const color = colorOfHex(`#${word}`);
    return color && { value, color };
};
const opacityPoint = (value: number, word: string): OpacityPoint | null => {
    const perKm = word === '' ? NaN : Number(word);
    return perKm >= 0 && Number.isFinite(perKm) ? { value, perKm: roundedPerKm(perKm) } : null;
};

// Reads a draft; null if the text is not a draft.
export function draftOfText(text: string): Draft | null {
    if (text.length > mostLetters) return null;
    const fields = text.split('!');
    if (fields.length !== 8) return null;
    const [moment, name, kind, begin, end, folded, colorText, opacityText] = fields as [
        string,
        string,
        string,
        string,
        string,
        string,
        string,
        string,
    ];
    const isStepped = kind === 'classes';
    const colors = pairs(colorText, colorPoint);
    const opacity = opacityText === '' ? null : pairs(opacityText, opacityPoint);
    const rangeFolded = colorOfHex(`#${folded}`);
    const [barBegin, barEnd] = [Number(begin), Number(end)];
    if (
        !Object.prototype.hasOwnProperty.call(knownMoments, moment) ||
        (!isStepped && kind !== 'blend') ||
        !/^[\w.-]{0,60}$/.test(name)
    )
        return null;
    if (!colors || colors.length < (isStepped ? 1 : 2) || !rises(colors, !isStepped) || !rangeFolded) return null;
    if (opacityText !== '' && (!opacity || !rises(opacity, false))) return null;
    if (!(barEnd > barBegin) || !Number.isFinite(barBegin) || !Number.isFinite(barEnd) || colors[0]!.value >= barEnd)
        return null;
    const unit = knownMoments[moment]!;
    return {
        name,
        moment,
        unit,
        isStepped,
        colors,
        opacity,
        end: roundedValue(barEnd),
        barBegin: roundedValue(barBegin),
        rangeFolded,
    };
}
