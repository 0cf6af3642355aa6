// Explains the colors of echo on the map of all stations, and how old the echo is.

import { colorOf } from '../tables/color_table';
import { ColorTable } from '../wire/color_tables';
import { make } from './dom';
import { mapTexts } from './later_texts';

const barPixels = 160;

export function mapLegend(table: ColorTable): HTMLElement[] {
    const bar = make('canvas', { width: String(barPixels), height: '1', 'aria-hidden': 'true' });
    const pen = bar.getContext('2d')!;
    const [from, to] = [table.bar_begin, table.end];
    for (let x = 0; x < barPixels; ++x) {
        const color = colorOf(table, from + ((x + 0.5) / barPixels) * (to - from));
        if (!color) continue;
        pen.fillStyle = `rgb(${color.slice(0, 3).join(' ')})`;
        pen.fillRect(x, 0, 1, 1);
    }
    const { reflectivity, unseen, newest } = mapTexts.legend;
    return [
        make('span', {}, `${reflectivity} ${from}`, bar, `${to} ${table.unit}`),
        make('span', {}, make('span', { class: 'unseen' }), unseen),
        make('span', {}, newest),
    ];
}
