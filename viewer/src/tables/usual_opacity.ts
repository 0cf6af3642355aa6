// Finds the opacity of a moment's echo if a table does not say it, as default_extinction() of
// render/color/built_in_tables.h does, from the tables of the server.

import { colorOf } from './color_table';
import { ColorTable, ExtinctionPoint } from '../wire/color_tables';

export interface UsualOpacity {
    of(moment: string, lowest: number): ExtinctionPoint[];
}

const [lowestDbz, highestDbz] = [-32, 79];

// Reflectivity has a point at each decibel from the lowest color on, and the veil of its first point
// below; other moments have the same points in each table.
function reflectivityFrom(points: ExtinctionPoint[], lowest: number): ExtinctionPoint[] {
    const first = Math.floor(Math.min(highestDbz, Math.max(lowestDbz, lowest)));
    const made: ExtinctionPoint[] = [];
    for (let value = first; value < points[0]!.value; ++value) made.push({ value, per_km: points[0]!.per_km });
    return [...made, ...points.filter((point) => point.value >= first)];
}

// `usual` names the table of each moment whose opacity is the moment's own.
export function usualOpacity(tables: ColorTable[], usual: Record<string, string>): UsualOpacity {
    return {
        of(moment, lowest) {
            const points = tables.find((table) => table.name === usual[moment])?.extinction;
            if (!points) throw new Error(`${moment}: no opacity is known`);
            return moment === 'REF' ? reflectivityFrom(points, lowest) : points;
        },
    };
}

// Returns the opacity of a table that is for no moment.
export function rising(lowest: number, end: number): ExtinctionPoint[] {
    return [
        { value: lowest, per_km: 0.02 },
        { value: end, per_km: 0.5 },
    ];
}

// Multiplies by the table's alpha, so that what is transparent in the table is so in a volume, too.
export function fadedByAlpha(points: ExtinctionPoint[], table: ColorTable): ExtinctionPoint[] {
    const lowest = table.stops[0]!.from;
    return points.map(({ value, per_km }) => ({
        value,
        per_km: (per_km * Math.round(colorOf(table, Math.max(value, lowest))![3])) / 255,
    }));
}
