// Computes the box of a grid's cells.

import { Box, heightRange } from '../camera/geometry';
import { PackedGrid } from '../wire/packed_grid';
import { Plane, cellSizeM, halfWidthsM } from '../earth/projection';

export function boxOf(grid: PackedGrid): Box {
    const [halfXM, halfYM] = halfWidthsM(grid);
    return { halfXM, halfYM, ...heightRange(grid.levelsM) };
}

// A grid, and where its middle is on the plane of the shown grid.
export interface Cells {
    grid: PackedGrid;
    middle: Plane;
}

// The extent of the cells of a grid on a plane.
export interface Extent {
    westM: number;
    southM: number;
    eastM: number;
    northM: number;
}

export function extentOf({ grid, middle }: Cells): Extent {
    const { halfXM, halfYM } = boxOf(grid);
    return {
        westM: middle[0] - halfXM,
        southM: middle[1] - halfYM,
        eastM: middle[0] + halfXM,
        northM: middle[1] + halfYM,
    };
}

// Place of a grid: its first cell, counted in cells of the shown grid, and its number of halvings.
export interface Placing {
    first: [number, number];
    halvings: number;
}
export function placingOf(cells: Cells, shown: PackedGrid): Placing {
    const [width, height] = cellSizeM(shown);
    const { westM, southM } = extentOf(cells);
    return { first: [westM / width + 0.5 * shown.nx, southM / height + 0.5 * shown.ny], halvings: cells.grid.halvings };
}
