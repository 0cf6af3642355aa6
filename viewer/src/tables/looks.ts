// Prepares a color table for flat layers, which look up colors by value.

import { colorOf } from './color_table';
import { ColorTable } from '../wire/color_tables';

// Entries fill the rows of a texture.
export const lookColumns = 2048;
export const lookCount = 4 * lookColumns;

export interface Looks {
    // Red, green, blue and opacity of each entry, 0 to 255. The first entry is clear, for values below the table.
    rgba: Uint8Array;
    // entry = offset + slope * value, rounded down
    offset: number;
    slope: number;
}

// Moves each value up by a little, so that the value at which a class begins has the color of this class.
const slack = 1 / 64;

export function looksOf(table: ColorTable, least: number): Looks {
    const low = table.stops[0]!.from;
    const high = Math.max(table.end, table.stops[table.stops.length - 1]!.from);
    const width = (high - low) / (lookCount - 1);
    const rgba = new Uint8Array(4 * lookCount);
    for (let i = 1; i < lookCount; ++i) {
        // Values equal to the threshold are shown.
        const isHidden = low + (i - slack) * width <= least;
        const color = isHidden ? null : colorOf(table, low + (i - 0.5) * width);
        if (color) rgba.set(color.map(Math.round), 4 * i);
    }
    return { rgba, offset: 1 + slack - low / width, slope: 1 / width };
}

// Returns the color of a value blended over the color `under`; null if the value is clear.
export function lookOver(looks: Looks, value: number, under: readonly number[]): [number, number, number] | null {
    const entry = Math.min(lookCount - 1, Math.max(0, Math.floor(looks.offset + looks.slope * value)));
    const alpha = looks.rgba[4 * entry + 3]! / 255;
    if (alpha === 0) return null;
    return [0, 1, 2].map((c) => Math.round(under[c]! + alpha * (looks.rgba[4 * entry + c]! - under[c]!))) as [
        number,
        number,
        number,
    ];
}
