// The colors with their values, beside the picture.

import { ColorTable, colorOf } from '../tables/color_table';
import { shades } from '../renderer/shades';

function stepOf(range: number): number {
    const rough = range / 8;
    const power = 10 ** Math.floor(Math.log10(rough));
    return ([1, 2, 5, 10].find(step => step * power >= rough) ?? 10) * power;
}

export function drawColorBar(canvas: HTMLCanvasElement, table: ColorTable, unit: string, least: number | null): void {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext('2d')!;
    pen.scale(ratio, ratio);
    const [low, high] = [table.bar_begin, table.end];
    const [top, bottom] = [22, height - 8];
    const yOf = (value: number) => bottom - ((value - low) / (high - low)) * (bottom - top);
    for (let y = top; y < bottom; ++y) {
        const value = low + ((bottom - y - 0.5) / (bottom - top)) * (high - low);
        const color = colorOf(table, value);
        if (!color) continue;
        const isHidden = least !== null && value < least;
        pen.fillStyle = `rgba(${color[0]}, ${color[1]}, ${color[2]}, ${isHidden ? 0.15 : 1})`;
        pen.fillRect(0, y, 14, 1);
    }
    pen.font = '12px "DejaVu Sans", system-ui, sans-serif';
    pen.textBaseline = 'middle';
    pen.fillStyle = shades.text;
    pen.fillText(unit, 0, 10);
    const step = stepOf(high - low);
    for (let value = Math.ceil(low / step) * step; value <= high + 1e-9; value += step) {
        pen.fillStyle = shades.quietText;
        pen.fillRect(14, yOf(value) - 0.5, 4, 1);
        pen.fillText(String(Number(value.toFixed(3))), 21, yOf(value));
    }
}
