// Makes a color table of the content of a file. render/color/color_file.h has the same rules, so that `stormcellar
// frame --colors FILE` and the page draw the same picture.
//
// Errors: a TableError that names the file, the line if there is one, and the reason.

import { colorFiles, moments } from '../facts';
import { ColorTable, Rgba } from '../wire/color_tables';
import { UsualOpacity, fadedByAlpha, rising } from './usual_opacity';

export class TableError extends Error {}

export const { mostBytes: mostFileBytes, mostStops, greatestValue } = colorFiles;

// Units of moments in files of colors, by name of the moment; an empty text for a moment without a unit.
export const knownMoments: Record<string, string> = Object.fromEntries(
    Object.entries(moments).map(([name, { unit }]) => [name, unit === '1' ? '' : unit]),
);

export interface FilePoint {
    value: number;
    color: Rgba;
    until?: Rgba; // color to which this point blends; without it, the color of the next point
    perKm: number | null; // null in all points or in none; null: the usual opacity
}

// The content of a TOML file.
export interface TableFile {
    name: string;
    moment: string | null;
    unit: string;
    isStepped: boolean;
    end: number | null;
    rangeFolded: Rgba | null;
    points: FilePoint[]; // values rise; at least two, or at least one if the table is stepped
}

// Returns the end of the color bar for a table that does not state it. The last class is as long as the class before.
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

// Returns the opacity for a table whose file does not state it.
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

// Reads a color "#rrggbb" or "#rrggbbaa"; null if the text is not a color.
export function colorOfHex(text: string): Rgba | null {
    const found = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})?$/i.exec(text);
    if (!found) return null;
    return [found[1]!, found[2]!, found[3]!, found[4] ?? 'ff'].map((digits) => parseInt(digits, 16)) as Rgba;
}

// Returns the first 64 characters of a word from a file, without control characters, for a message.
export function shownWord(word: string): string {
    return word.slice(0, 64).replace(/[^\x20-\x7e]/g, '?');
}
