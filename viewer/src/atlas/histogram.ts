// Counts how often each value occurs in a grid. A whole grid is counted by its exact codes. A grid that comes in parts
// is counted by the shown codes (eight bits) of its first halved grid.

import { Atlas } from './atlas';
import { PackedGrid, mayHoldValues, valueOf } from '../wire/packed_grid';

// Returns the number of cells of each code; 0 for codes that are not values.
export function countCodes(
    grid: PackedGrid,
    atlas: Pick<Atlas, 'histogram' | 'codeOffset' | 'codeScale'>,
): Uint32Array {
    const counts = new Uint32Array(grid.codeBytes === 1 ? 256 : 65536);
    if (grid.codes.length === 0) {
        atlas.histogram.forEach(
            (count, shown) => (counts[Math.round(atlas.codeOffset + atlas.codeScale * shown)]! += count),
        );
        counts.fill(0, 0, grid.firstCode);
        return counts;
    }
    const cells = grid.brickEdge ** 3;
    for (let brick = 0; brick < grid.kind.length; ++brick) {
        if (!mayHoldValues(grid, brick)) continue;
        const from = grid.block[brick]! * cells;
        for (let i = from; i < from + cells; ++i) ++counts[grid.codes[i]!]!;
    }
    counts.fill(0, 0, grid.firstCode);
    return counts;
}

// Returns the number of cells in each of at most `most` columns of equal width from `low` to `high`. Values below
// `low`, and values of `high` or more, are not counted.
export function histogramOf(
    grid: PackedGrid,
    counts: Uint32Array,
    [low, high]: readonly [number, number],
    most: number,
): Uint32Array {
    const codes = Math.max(1, (high - low) / grid.step);
    const columns = Math.ceil(codes / Math.ceil(codes / most) - 1e-6);
    const histogram = new Uint32Array(columns);
    for (let code = grid.firstCode; code < counts.length; ++code) {
        if (counts[code] === 0) continue;
        const column = Math.floor(((valueOf(grid, code) - low) / (high - low)) * columns + 1e-6);
        if (column >= 0 && column < columns) histogram[column]! += counts[code]!;
    }
    return histogram;
}
