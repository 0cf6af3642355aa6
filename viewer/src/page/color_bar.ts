// Draws the bar of colors and their values beside the picture.

import { colorOf } from '../tables/color_table';
import { ColorTable } from '../wire/color_tables';
import { ShownUnit } from '../tables/units';
import { isVelocity } from '../wire/moments';
import { shades } from '../renderer/shades';
import { fontOf, penOf, textScale } from './dom';
import { haloed } from './labels';
import { texts } from './texts';

// Returns a round distance between the marks of an axis, so that there are about eight.
export function stepOf(range: number): number {
    const rough = range / 8;
    const power = 10 ** Math.floor(Math.log10(rough));
    return ([1, 2, 5, 10].find((step) => step * power >= rough) ?? 10) * power;
}

export type BarEnds = readonly [high: string, low: string];

// Velocities of these moments are away from the radar at one end of the bar of colors, and toward it at the other.
export const endsOf = (moment: string): BarEnds | null => (isVelocity(moment) ? texts.velocityEnds : null);

export class ColorBar {
    private drawn: readonly unknown[] = [];

    constructor(private canvas: HTMLCanvasElement) {}

    // Draws the bar, unless it is already drawn. `ends` are words for the highest and the lowest values.
    show(table: ColorTable, unit: ShownUnit, least: number | null, ends: BarEnds | null): void {
        const { clientWidth, clientHeight } = this.canvas;
        const wanted = [
            table,
            unit.symbol,
            unit.perStored,
            least,
            ends,
            clientWidth,
            clientHeight,
            window.devicePixelRatio,
            textScale(),
        ];
        if (wanted.every((part, i) => part === this.drawn[i])) return;
        this.drawn = wanted;
        drawBar(this.canvas, table, unit, least, ends);
    }
}

function drawBar(
    canvas: HTMLCanvasElement,
    table: ColorTable,
    unit: ShownUnit,
    least: number | null,
    ends: BarEnds | null,
): void {
    const pen = penOf(canvas);
    const scale = textScale();
    const height = canvas.clientHeight / scale;
    const [low, high] = [table.bar_begin, table.end];
    const [top, bottom] = ends ? [36, height - 24] : [22, height - 8];
    const yOf = (value: number) => bottom - ((value - low) / (high - low)) * (bottom - top);
    const row = 1 / scale;
    for (let y = top; y < bottom; y += row) {
        const value = low + ((bottom - y - 0.5 * row) / (bottom - top)) * (high - low);
        const color = colorOf(table, value);
        if (!color) continue;
        const isHidden = least !== null && value < least;
        pen.fillStyle = `rgba(${color[0]}, ${color[1]}, ${color[2]}, ${isHidden ? 0.15 : 1})`;
        pen.fillRect(0, y, 14, row);
    }
    pen.font = fontOf(12);
    pen.textBaseline = 'middle';
    haloed(pen, unit.symbol, 2, 10, shades.text);
    pen.font = fontOf(11);
    ends?.forEach((word, i) => haloed(pen, word, 0, i === 0 ? 26 : height - 9, shades.text));
    pen.font = fontOf(12);
    // Marks are at round numbers of the shown unit.
    const [from, to] = [low * unit.perStored, high * unit.perStored];
    const step = stepOf(to - from);
    for (let number = Math.ceil(from / step) * step; number <= to + 1e-9; number += step) {
        const y = yOf(number / unit.perStored);
        pen.fillStyle = shades.quietText;
        pen.fillRect(14, y - 0.5, 4, 1);
        haloed(pen, String(Number(number.toFixed(3))), 21, y, shades.text);
    }
}
