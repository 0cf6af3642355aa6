// Reads a column of cells from the exact codes of a grid.

import { cellSizeM } from '../earth/projection';
import { CellState, PackedGrid, codeAt, stateOf, valueOf } from '../wire/packed_grid';

export interface LevelReading {
    heightM: number;
    state: CellState;
    value: number | null;
}
export interface ColumnReading {
    levels: LevelReading[]; // from the bottom
    greatest: { heightM: number; value: number } | null;
    seenM: [number, number] | null; // heights of the lowest and the highest seen cell
}

// Returns the column whose cells hold a point of the plane; null beyond the grid.
export function columnAt(grid: PackedGrid, xM: number, yM: number): [number, number] | null {
    const [width, height] = cellSizeM(grid);
    const x = Math.floor(xM / width + 0.5 * grid.nx);
    const y = Math.floor(yM / height + 0.5 * grid.ny);
    return x >= 0 && y >= 0 && x < grid.nx && y < grid.ny ? [x, y] : null;
}

export function readColumn(grid: PackedGrid, x: number, y: number): ColumnReading {
    const reading: ColumnReading = { levels: [], greatest: null, seenM: null };
    for (let z = 0; z < grid.nz; ++z) {
        const code = codeAt(grid, x, y, z);
        const heightM = grid.levelsM[z]!;
        const state = stateOf(grid, code);
        const value = state === CellState.value ? valueOf(grid, code) : null;
        reading.levels.push({ heightM, state, value });
        if (value !== null && (reading.greatest === null || value > reading.greatest.value))
            reading.greatest = { heightM, value };
        if (state !== CellState.notSeen) reading.seenM = [reading.seenM?.[0] ?? heightM, heightM];
    }
    return reading;
}
