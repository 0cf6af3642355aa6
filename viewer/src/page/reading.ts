// Reads what the column at a place holds, from the exact codes.

import { cellSizeM } from '../earth/projection';
import { PackedGrid, codeAt, firstValueCode, valueOf } from '../wire/packed_grid';

export interface LevelReading {
    heightM: number;
    code: number;
    value: number | null;
}
export interface ColumnReading {
    levels: LevelReading[]; // from the bottom
    greatest: LevelReading | null;
    seenFromM: number | null; // between these heights the column was seen
    seenToM: number | null;
}

// The column whose cell holds a point of the plane; null beyond the grid.
export function columnAt(grid: PackedGrid, xM: number, yM: number): [number, number] | null {
    const [width, height] = cellSizeM(grid);
    const x = Math.floor(xM / width + 0.5 * grid.nx);
    const y = Math.floor(yM / height + 0.5 * grid.ny);
    return x >= 0 && y >= 0 && x < grid.nx && y < grid.ny ? [x, y] : null;
}

export function readColumn(grid: PackedGrid, x: number, y: number): ColumnReading {
    const reading: ColumnReading = { levels: [], greatest: null, seenFromM: null, seenToM: null };
    for (let z = 0; z < grid.nz; ++z) {
        const code = codeAt(grid, x, y, z);
        const level: LevelReading = {
            heightM: grid.levelsM[z]!,
            code,
            value: code >= firstValueCode ? valueOf(grid, code) : null,
        };
        reading.levels.push(level);
        if (level.value !== null && (reading.greatest === null || level.value > reading.greatest.value!))
            reading.greatest = level;
        if (code > 0) {
            reading.seenFromM ??= level.heightM;
            reading.seenToM = level.heightM;
        }
    }
    return reading;
}
