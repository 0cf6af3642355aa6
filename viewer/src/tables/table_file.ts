// Makes a color table of the content of a file. render/color/color_file.h has the same rules, so that `stormcellar
// frame --colors FILE` and the page draw the same.
//
// Errors: a TableError that names the file, the line where there is one, and the reason.

import { colorFiles, moments } from '../facts';
import { ColorTable, Rgba } from '../wire/color_tables';
import { UsualOpacity, fadedByAlpha, rising } from './usual_opacity';

export class TableError extends Error {}

export const { mostBytes: mostFileBytes, mostStops, greatestValue } = colorFiles;

// Moments by name, with the unit that a file of colors writes: none for a number.
export const knownMoments: Record<string, string> = Object.fromEntries(
    Object.entries(moments).map(([name, { unit }]) => [name, unit === '1' ? '' : unit]),
);

export interface FilePoint {
    value: number;
    color: Rgba;
    until?: Rgba; // to which it blends, instead of the next point's
    perKm: number | null; // null in all points or in none
}

// The content of a TOML file.
export interface TableFile {
    name: string;
    moment: string | null;
    unit: string;
    isStepped: boolean;
    end: number | null;
    rangeFolded: Rgba | null;
    points: FilePoint[]; // values rise; at least two, or one of a stepped table
}

// Returns the end of the color bar of a table that does not say it: its last class is as long as the one before.
export function endOf(table: ColorTable): number {
    const { stops } = table;
    const [before, last] = [stops[stops.length - 2]?.from, stops[stops.length - 1]!.from];
    return last + (before === undefined ? 1 : last - before);
}

export function tableOfFile(file: TableFile, usual: UsualOpacity): ColorTable {
    const points = file.points.map((point) => ({ ...point, value: Math.fround(point.value) }));
    const table: ColorTable = {
        name: file.name,
        moment: file.moment ?? '',
        unit: file.unit,
        stops: points.map(({ value, color, until }, i) => ({
            from: value,
            color,
            until: until ?? (file.isStepped ? color : (points[i + 1]?.color ?? color)),
        })),
        end: 0,
        bar_begin: points[0]!.value,
        range_folded: file.rangeFolded ?? [...colorFiles.rangeFolded],
        extinction: [],
    };
    table.end = file.end ?? endOf(table);
    table.extinction = points.flatMap(({ value, perKm }) => (perKm === null ? [] : [{ value, per_km: perKm }]));
    if (table.extinction.length === 0) table.extinction = usualExtinctionOf(table, usual);
    return table;
}

// Returns the opacity of a table whose file does not say it.
export function usualExtinctionOf(table: ColorTable, usual: UsualOpacity): ColorTable['extinction'] {
    const lowest = table.stops[0]!.from;
    return fadedByAlpha(table.moment ? usual.of(table.moment, lowest) : rising(lowest, table.end), table);
}

const twoDigits = (channel: number): string => channel.toString(16).padStart(2, '0');

// Writes a color as "#rrggbb", with alpha if it is not opaque.
export function hexOf(color: Rgba): string {
    const channels = color[3] === 255 ? color.slice(0, 3) : color;
    return `#${channels.map(twoDigits).join('')}`;
}

// Reads such a color; null if the text is none.
export function colorOfHex(text: string): Rgba | null {
    const found = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})?$/i.exec(text);
    if (!found) return null;
    return [found[1]!, found[2]!, found[3]!, found[4] ?? 'ff'].map((digits) => parseInt(digits, 16)) as Rgba;
}

// Returns a part of a file in a form that is safe in a message.
export function shownWord(word: string): string {
    return word.slice(0, 64).replace(/[^\x20-\x7e]/g, '?');
}
