// Derives from the table of a grid which bricks of its halved grids can hold values, and bounds these values. Halving
// merges 2 x 2 columns of cells into one.
//
// A level is a number of halvings. A column of bricks is all bricks above one place; its number is
// x * (bricks along y) + y, as in the packed form.

import { PackedGrid, mayHoldValues } from '../wire/packed_grid';

export const mostHalvings = 6;

export interface Level {
    columns: [number, number]; // number of columns of bricks along x and y
    // Upper bound of the codes of values in each brick, z fastest, then y, then x; 0 without values.
    greatest: Uint16Array;
    // Upper bound over each brick and the bricks that touch it.
    about: Uint16Array;
    // Number of bricks in each column whose `about` is not 0.
    shown: Uint8Array;
}

export interface Pyramid {
    layers: number; // number of bricks in a column
    levels: Level[];
}

function greatestOf(grid: PackedGrid): Uint16Array {
    return grid.greatestCode.map((code, i) => (mayHoldValues(grid, i) ? code : 0));
}

function halved(from: Level, layers: number): Level {
    const [fx, fy] = from.columns;
    const columns: [number, number] = [Math.ceil(fx / 2), Math.ceil(fy / 2)];
    const greatest = new Uint16Array(columns[0] * columns[1] * layers);
    for (let x = 0; x < fx; ++x) {
        for (let y = 0; y < fy; ++y) {
            const to = ((x >> 1) * columns[1] + (y >> 1)) * layers;
            const at = (x * fy + y) * layers;
            for (let z = 0; z < layers; ++z) greatest[to + z] = Math.max(greatest[to + z]!, from.greatest[at + z]!);
        }
    }
    return withNeighbors(columns, greatest, layers);
}

// Replaces each number by the greatest of the number and its two neighbors along an axis, in a copy. The axis has
// `count` numbers, which are `stride` apart.
function widened(from: Uint16Array, count: number, stride: number): Uint16Array {
    return from.map((code, i) => {
        const place = Math.floor(i / stride) % count;
        const before = place > 0 ? from[i - stride]! : 0;
        const behind = place + 1 < count ? from[i + stride]! : 0;
        return Math.max(code, before, behind);
    });
}

function withNeighbors(columns: [number, number], greatest: Uint16Array, layers: number): Level {
    const upright = widened(greatest, layers, 1);
    const about = widened(widened(upright, columns[1], layers), columns[0], columns[1] * layers);
    const shown = new Uint8Array(columns[0] * columns[1]);
    about.forEach((code, i) => (shown[Math.floor(i / layers)]! += code > 0 ? 1 : 0));
    return { columns, greatest, about, shown };
}

export function pyramidOf(grid: PackedGrid): Pyramid {
    const [bx, by, layers] = grid.bricks;
    const levels = [withNeighbors([bx, by], greatestOf(grid), layers)];
    for (let i = 0; i < mostHalvings; ++i) levels.push(halved(levels[i]!, layers));
    return { layers, levels };
}

export function bricksShown(level: Level): number {
    return level.shown.reduce((sum, count) => sum + count, 0);
}

// Returns the finest level with at most `mostBricks` bricks that can show anything; the coarsest level if all have
// more.
export function levelWithin(pyramid: Pyramid, mostBricks: number): number {
    const found = pyramid.levels.findIndex((level) => bricksShown(level) <= mostBricks);
    return found < 0 ? mostHalvings : found;
}
