// How often each value occurs in a grid, from its exact codes.

import { BrickKind, PackedGrid, firstValueCode, valueOf } from '../wire/packed_grid';

// Of each code of a value how many cells have it. Cells of a brick beyond the grid have no values.
export function countCodes(grid: PackedGrid): Uint32Array {
    const counts = new Uint32Array(grid.codeBytes === 1 ? 256 : 65536);
    const cells = grid.brickEdge ** 3;
    for (let brick = 0; brick < grid.kind.length; ++brick) {
        if (grid.kind[brick] !== BrickKind.codes || grid.valueCount[brick] === 0) continue;
        const from = grid.block[brick]! * cells;
        for (let i = from; i < from + cells; ++i) ++counts[grid.codes[i]!]!;
    }
    counts.fill(0, 0, firstValueCode);
    return counts;
}

// Counts in columns of equal width from `low` to `high`; values beyond are in the outermost.
export function histogramOf(grid: PackedGrid, low: number, high: number, columns: number): Uint32Array {
    const counts = countCodes(grid);
    const histogram = new Uint32Array(columns);
    for (let code = firstValueCode; code < counts.length; ++code) {
        if (counts[code] === 0) continue;
        const column = Math.floor(((valueOf(grid, code) - low) / (high - low)) * columns);
        histogram[Math.min(columns - 1, Math.max(0, column))]! += counts[code]!;
    }
    return histogram;
}
