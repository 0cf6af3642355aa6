// The box of a grid's cells.

import { Box, heightRange } from '../camera/geometry';
import { PackedGrid } from '../wire/packed_grid';
import { cellSizeM } from './projection';

export function boxOf(grid: PackedGrid): Box {
    const [width, height] = cellSizeM(grid);
    return { halfXM: 0.5 * grid.nx * width, halfYM: 0.5 * grid.ny * height, ...heightRange(grid.levelsM) };
}
