// Plots the column at a place: its values over height, and the heights that beams saw.

import { colorOf } from '../../tables/color_table';
import { heightText, shownUnit } from '../../tables/units';
import { App } from '../app';
import { fontOf, make, pixelRatio, textScale } from '../dom';
import { ColumnReading, LevelReading } from '../column_reading';
import { shades } from '../../renderer/shades';
import { panelTexts } from '../later_texts';
import { CellState } from '../../wire/packed_grid';

const [width, height] = [250, 130]; // pixels at the usual size of texts
const [left, bottom] = [52, 20];

export function profilePlot(app: App, reading: ColumnReading): HTMLCanvasElement {
    const canvas = make('canvas', { class: 'profile', role: 'img', 'aria-label': panelTexts.tools.profile });
    const { shownTable: table, unit } = app;
    const { units } = app.state;
    const scale = pixelRatio() * textScale();
    [canvas.width, canvas.height] = [Math.round(width * scale), Math.round(height * scale)];
    const pen = canvas.getContext('2d')!;
    pen.scale(scale, scale);
    const { levels } = reading;
    if (!table || levels.length < 2) return canvas;
    const [lowM, highM] = [levels[0]!.heightM, levels[levels.length - 1]!.heightM];
    const values = levels.flatMap((level) => (level.value === null ? [] : [level.value]));
    const [from, to] = [Math.min(table.bar_begin, ...values), Math.max(table.end, ...values)];
    const x = (value: number) => left + ((value - from) / (to - from)) * (width - left - 8);
    const y = (heightM: number) =>
        height - bottom - ((heightM - lowM) / Math.max(1, highM - lowM)) * (height - bottom - 8);
    // Draw a level gray if no beam saw it, in the color of range folded air if it is range folded, half as dense if it
    // is ambiguous, and dark otherwise. A value is a bar in its color.
    const shadeOf: Partial<Record<CellState, string>> = {
        [CellState.notSeen]: 'rgba(78, 82, 92, 0.55)',
        [CellState.rangeFolded]: 'rgba(124, 74, 140, 0.6)',
        [CellState.ambiguous]: 'rgba(124, 74, 140, 0.3)',
    };
    for (let i = 0; i < levels.length; ++i) {
        const { heightM, state, value } = levels[i]!;
        const middle = (other: LevelReading | undefined) => y(((other?.heightM ?? heightM) + heightM) / 2);
        const above = middle(levels[i + 1]);
        const tall = middle(levels[i - 1]) - above;
        pen.fillStyle = shadeOf[state] ?? 'rgba(40, 44, 50, 0.9)';
        pen.fillRect(left, above, width - left - 8, tall);
        const color = value === null ? null : colorOf(table, value);
        if (value === null || !color) continue;
        pen.fillStyle = `rgb(${color.slice(0, 3).join(',')})`;
        pen.fillRect(left, above + 0.4, x(value) - left, tall - 0.8);
    }
    pen.font = fontOf(10);
    pen.fillStyle = shades.quietText;
    pen.textBaseline = 'middle';
    pen.textAlign = 'right';
    for (const share of [0, 0.5, 1])
        pen.fillText(
            heightText(lowM + share * (highM - lowM), units),
            left - 4,
            Math.min(height - bottom, Math.max(8, y(lowM + share * (highM - lowM)))),
        );
    pen.textAlign = 'center';
    const { perStored, symbol } = shownUnit(unit, units);
    for (const share of [0, 0.5, 1]) {
        const value = from + share * (to - from);
        pen.fillText(
            `${Math.round(value * perStored)}${share === 1 ? ` ${symbol}` : ''}`,
            Math.min(width - 24, x(value)),
            height - bottom / 2,
        );
    }
    return canvas;
}
