// Bricks of a grid as one texture: each brick with values is stored with a border of its neighbors'
// cells, so that the hardware interpolates across bricks. R is a code, G tells whether the cell has a
// value: interpolated, R over G is the mean of the values alone, and states never become values.
//
// Codes of two bytes are shown through eight bits (codeScale, codeOffset); exact codes stay in the
// packed grid, which the probe reads.

import { BrickKind, PackedGrid, firstValueCode } from '../wire/packed_grid';

export const paddedEdge = 18;

export interface Atlas {
    size: [number, number, number]; // texels
    slots: [number, number, number]; // bricks along each axis
    brickCount: number; // in the atlas
    texels: Uint8Array; // RG, x fastest
    // Of each brick of the grid, x fastest: 0 for none, else 1 + its slot, and in the highest byte the
    // greatest shown code of the cells that a sample in it can use.
    indirection: Uint32Array;
    bricks: [number, number, number];
    // code = codeOffset + codeScale * shown code
    codeScale: number;
    codeOffset: number;
    least: number; // codes of values; least > greatest: there is none
    greatest: number;
    // How many values have each shown code.
    histogram: Uint32Array;
}

function brickIndex(grid: PackedGrid, x: number, y: number, z: number): number {
    return (x * grid.bricks[1] + y) * grid.bricks[2] + z;
}

// The greatest code of a value in a brick and in those that lie above it along any axis, whose first
// cells a sample in the brick uses; 0 without values.
function greatestAbout(grid: PackedGrid, x: number, y: number, z: number): number {
    let greatest = 0;
    for (let dx = 0; dx < 2; ++dx) {
        for (let dy = 0; dy < 2; ++dy) {
            for (let dz = 0; dz < 2; ++dz) {
                if (x + dx >= grid.bricks[0] || y + dy >= grid.bricks[1] || z + dz >= grid.bricks[2]) continue;
                const brick = brickIndex(grid, x + dx, y + dy, z + dz);
                if (grid.kind[brick] !== BrickKind.codes || grid.valueCount[brick] === 0) continue;
                greatest = Math.max(greatest, grid.greatestCode[brick]!);
            }
        }
    }
    return greatest;
}

function rangeOfCodes(grid: PackedGrid): [number, number] {
    let least = 65535;
    let greatest = 0;
    for (let i = 0; i < grid.kind.length; ++i) {
        if (grid.kind[i] !== BrickKind.codes || grid.valueCount[i] === 0) continue;
        least = Math.min(least, grid.leastCode[i]!);
        greatest = Math.max(greatest, grid.greatestCode[i]!);
    }
    return [least, greatest];
}

// Slots in a box that is as near to a cube as rows of it allow.
function slotsFor(count: number, mostTexels: number): [number, number, number] {
    const most = Math.floor(mostTexels / paddedEdge);
    const side = Math.min(most, Math.max(1, Math.ceil(Math.cbrt(count))));
    const rows = Math.min(most, Math.max(1, Math.ceil(count / (side * side))));
    if (side * side * rows >= count) return [side, side, rows];
    return [most, most, Math.ceil(count / (most * most))];
}

interface Filling {
    grid: PackedGrid;
    atlas: Atlas;
    shownOf: Uint8Array; // shown code of each code of a value
}

// A run of cells along an axis that a slot takes from one brick of the grid.
interface Run {
    brick: number;
    from: number; // the first cell in that brick
    to: number; // its place in the slot
    count: number;
}

// The runs along an axis of the cells [16 b - 1, 16 b + 17). Beyond the grid the outermost cells go on, as
// the slicer has it.
function runsAlong(b: number, edge: number, cells: number): Run[] {
    const runs: Run[] = [];
    for (let i = 0; i < paddedEdge; ++i) {
        const cell = Math.min(cells - 1, Math.max(0, b * edge + i - 1));
        const brick = Math.floor(cell / edge);
        const last = runs[runs.length - 1];
        if (last && last.brick === brick && last.from + last.count === cell - brick * edge) ++last.count;
        else runs.push({ brick, from: cell - brick * edge, to: i, count: 1 });
    }
    return runs;
}

// Copies what a slot takes from one brick with values.
function copyRuns(filling: Filling, block: number, first: number, rows: [Run, Run, Run]): void {
    const { grid, atlas, shownOf } = filling;
    const [xs, ys, zs] = rows;
    const edge = grid.brickEdge;
    const { codes } = grid;
    const { texels, size } = atlas;
    // Texels are written in the order in which they lie; a brick is small enough to be read in any.
    for (let z = 0; z < zs.count; ++z) {
        for (let y = 0; y < ys.count; ++y) {
            let from = block * edge ** 3 + (xs.from * edge + ys.from + y) * edge + zs.from + z;
            let to = first + 2 * (((zs.to + z) * size[1] + ys.to + y) * size[0] + xs.to);
            for (let x = 0; x < xs.count; ++x, from += edge * edge, to += 2) {
                const code = codes[from]!;
                if (code < firstValueCode) continue;
                texels[to] = shownOf[code]!;
                texels[to + 1] = 255;
            }
        }
    }
}

// Copies a brick and one cell of its neighbors on each side into a slot; where they have no values, the
// slot stays 0.
function fillSlot(filling: Filling, bx: number, by: number, bz: number, slot: number): void {
    const { grid, atlas } = filling;
    const edge = grid.brickEdge;
    const [sx, sy] = atlas.slots;
    const [width, height] = atlas.size;
    const corner = [slot % sx, Math.floor(slot / sx) % sy, Math.floor(slot / (sx * sy))].map(n => n * paddedEdge) as [number, number, number];
    const first = 2 * ((corner[2] * height + corner[1]) * width + corner[0]);
    const [xs, ys, zs] = [runsAlong(bx, edge, grid.nx), runsAlong(by, edge, grid.ny), runsAlong(bz, edge, grid.nz)];
    for (const x of xs) {
        for (const y of ys) {
            for (const z of zs) {
                const brick = brickIndex(grid, x.brick, y.brick, z.brick);
                if (grid.kind[brick] === BrickKind.codes) copyRuns(filling, grid.block[brick]!, first, [x, y, z]);
            }
        }
    }
}

function shownCodes(grid: PackedGrid, least: number, greatest: number): { table: Uint8Array; scale: number; offset: number } {
    const table = new Uint8Array(65536);
    const isExact = grid.codeBytes === 1;
    const scale = isExact ? 1 : Math.max(1, (greatest - least) / 252);
    const offset = isExact ? 0 : least - firstValueCode * scale;
    for (let code = firstValueCode; code < table.length; ++code) {
        table[code] = Math.min(255, Math.max(firstValueCode, Math.round((code - offset) / scale)));
    }
    return { table, scale, offset };
}

function countValues(grid: PackedGrid, shownOf: Uint8Array, histogram: Uint32Array): void {
    const cells = grid.brickEdge ** 3;
    for (let brick = 0; brick < grid.kind.length; ++brick) {
        if (grid.kind[brick] !== BrickKind.codes) continue;
        const from = grid.block[brick]! * cells;
        for (let i = from; i < from + cells; ++i) {
            const code = grid.codes[i]!;
            if (code >= firstValueCode) ++histogram[shownOf[code]!]!;
        }
    }
}

// `mostTexels` is the greatest side of a 3D texture here. Errors: a RangeError if the grid needs more.
export function makeAtlas(grid: PackedGrid, mostTexels: number): Atlas {
    const [least, greatest] = rangeOfCodes(grid);
    const shown = shownCodes(grid, least, greatest);
    const [bx, by, bz] = grid.bricks;
    const wanted: [number, number, number, number][] = [];
    for (let z = 0; z < bz; ++z) {
        for (let y = 0; y < by; ++y) {
            for (let x = 0; x < bx; ++x) {
                const most = greatestAbout(grid, x, y, z);
                if (most > 0) wanted.push([x, y, z, shown.table[most]!]);
            }
        }
    }
    const slots = slotsFor(wanted.length, mostTexels);
    const size = slots.map(n => n * paddedEdge) as [number, number, number];
    if (size[2] > mostTexels) throw new RangeError('the grid has more bricks than a texture of this device holds');
    const atlas: Atlas = {
        size,
        slots,
        brickCount: wanted.length,
        texels: new Uint8Array(2 * size[0] * size[1] * size[2]),
        indirection: new Uint32Array(bx * by * bz),
        bricks: grid.bricks,
        codeScale: shown.scale,
        codeOffset: shown.offset,
        least,
        greatest,
        histogram: new Uint32Array(256),
    };
    wanted.forEach(([x, y, z, most], slot) => {
        atlas.indirection[(z * by + y) * bx + x] = (((most << 24) >>> 0) | (slot + 1)) >>> 0;
        fillSlot({ grid, atlas, shownOf: shown.table }, x, y, z, slot);
    });
    countValues(grid, shown.table, atlas.histogram);
    return atlas;
}

export const enum Coverage {
    notSeen = 0, // no cell of the column was seen
    high = 1, // seen, but from above 3 km only
    low = 2, // seen from below 3 km
}
const lowM = 3000;

// Lowers `lowest`, the lowest level of each column that was seen, by the cells of one brick.
function lowerByBrick(grid: PackedGrid, bx: number, by: number, bz: number, lowest: Uint16Array): void {
    const edge = grid.brickEdge;
    const brick = brickIndex(grid, bx, by, bz);
    const kind = grid.kind[brick];
    if (kind === BrickKind.uniform && grid.state[brick] === 0) return;
    const depth = Math.min(edge, grid.nz - bz * edge);
    const block = grid.block[brick]! * edge ** 3;
    for (let x = 0; x < Math.min(edge, grid.nx - bx * edge); ++x) {
        for (let y = 0; y < Math.min(edge, grid.ny - by * edge); ++y) {
            const column = (by * edge + y) * grid.nx + bx * edge + x;
            if (lowest[column]! <= bz * edge) continue;
            const from = block + (x * edge + y) * edge;
            let z = 0;
            if (kind === BrickKind.codes) while (z < depth && grid.codes[from + z] === 0) ++z;
            else if (kind === BrickKind.states) while (z < depth && ((grid.states[(from + z) >> 2]! >> (2 * ((from + z) & 3))) & 3) === 0) ++z;
            if (z < depth) lowest[column] = Math.min(lowest[column]!, bz * edge + z);
        }
    }
}

// What was seen of each column, x fastest.
export function coverageOf(grid: PackedGrid): Uint8Array {
    const never = 65535;
    const lowest = new Uint16Array(grid.nx * grid.ny).fill(never);
    for (let x = 0; x < grid.bricks[0]; ++x) {
        for (let y = 0; y < grid.bricks[1]; ++y) {
            for (let z = 0; z < grid.bricks[2]; ++z) lowerByBrick(grid, x, y, z, lowest);
        }
    }
    const coverage = new Uint8Array(lowest.length);
    for (let i = 0; i < lowest.length; ++i) {
        const level = lowest[i]!;
        if (level !== never) coverage[i] = grid.levelsM[level]! < lowM ? Coverage.low : Coverage.high;
    }
    return coverage;
}
