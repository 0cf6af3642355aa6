// Finds the opacity for a table whose file does not state one, from the server's tables. default_extinction() of
// render/color/built_in_tables.h gives the same opacity.

import { colorOf } from './color_table';
import { ColorTable, ExtinctionPoint } from '../wire/color_tables';

export interface UsualOpacity {
    of(moment: string, lowest: number): ExtinctionPoint[];
}

const [lowestDbz, highestDbz] = [-32, 79];

// Returns the points for a table of reflectivity that begins at `lowest`. There is a point at each decibel from there
// on; decibels below the server's first point get the opacity of that point.
function reflectivityFrom(points: ExtinctionPoint[], lowest: number): ExtinctionPoint[] {
    const first = Math.floor(Math.min(highestDbz, Math.max(lowestDbz, lowest)));
    const made: ExtinctionPoint[] = [];
    for (let value = first; value < points[0]!.value; ++value) made.push({ value, per_km: points[0]!.per_km });
    return [...made, ...points.filter((point) => point.value >= first)];
}

// Returns the usual opacities. `usual` gives for each moment the name of the table that has its usual opacity.
export function usualOpacity(tables: ColorTable[], usual: Record<string, string>): UsualOpacity {
    return {
        of(moment, lowest) {
            const points = tables.find((table) => table.name === usual[moment])?.extinction;
            if (!points) throw new Error(`${moment}: no opacity is known`);
            return moment === 'REF' ? reflectivityFrom(points, lowest) : points;
        },
    };
}

// Returns the opacity for a table that is for no moment.
export function rising(lowest: number, end: number): ExtinctionPoint[] {
    return [
        { value: lowest, per_km: 0.02 },
        { value: end, per_km: 0.5 },
    ];
}

// Multiplies opacities by the alpha of the table's colors, so that transparent colors are transparent in a volume, too.
export function fadedByAlpha(points: ExtinctionPoint[], table: ColorTable): ExtinctionPoint[] {
    const lowest = table.stops[0]!.from;
    return points.map(({ value, per_km }) => ({
        value,
        per_km: (per_km * Math.round(colorOf(table, Math.max(value, lowest))![3])) / 255,
    }));
}
