// What the table of a grid tells of the grids that are made by halving its columns and rows: which of
// their bricks can hold values, and how large.
//
// Numbers: a level is how often the grid was halved. A column of bricks has all bricks above one place;
// its number is x * (bricks along y) + y, as in the packed form.

import { BrickKind, PackedGrid } from '../wire/packed_grid';

export const mostHalvings = 6;

export interface Level {
    columns: [number, number]; // of bricks, along x and y
    // Of each brick, z fastest, then y, then x: the greatest code of a value, at most; 0 without values.
    greatest: Uint16Array;
    // The same of the brick and all that touch it.
    about: Uint16Array;
    // Of each column: how many of its bricks can show anything.
    shown: Uint8Array;
}

export interface Pyramid {
    layers: number; // bricks along z
    levels: Level[];
}

function greatestOf(grid: PackedGrid): Uint16Array {
    return grid.greatestCode.map((code, i) => (grid.kind[i] === BrickKind.codes && grid.valueCount[i]! > 0 ? code : 0));
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

// The greatest of three that follow each other along an axis, of which there are `count`, `stride` apart.
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

// The finest level of which all bricks that can show anything are at most so many; the coarsest if none is.
export function levelWithin(pyramid: Pyramid, mostBricks: number): number {
    const found = pyramid.levels.findIndex(level => bricksShown(level) <= mostBricks);
    return found < 0 ? mostHalvings : found;
}
