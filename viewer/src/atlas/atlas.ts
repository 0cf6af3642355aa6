// Bricks of a grid as one texture: each brick with values is stored with a border of its neighbors'
// cells, so that the hardware interpolates across bricks. R is a code, G tells whether the cell has a
// value: interpolated, R over G is the mean of the values alone, and states never become values.
//
// Codes of two bytes are shown through eight bits (codeScale, codeOffset); exact codes stay in the
// packed grid, which the probe reads.

import { BrickKind, PackedGrid, codeAt, firstValueCode } from '../wire/packed_grid';

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

// Copies the cells [16 b - 1, 16 b + 17) along each axis into a slot. Most lie in the brick itself.
function fillSlot(filling: Filling, bx: number, by: number, bz: number, slot: number): void {
    const { grid, atlas, shownOf } = filling;
    const edge = grid.brickEdge;
    const [sx, sy] = atlas.slots;
    const x0 = (slot % sx) * paddedEdge;
    const y0 = (Math.floor(slot / sx) % sy) * paddedEdge;
    const z0 = Math.floor(slot / (sx * sy)) * paddedEdge;
    const [width, height] = atlas.size;
    for (let z = 0; z < paddedEdge; ++z) {
        // Beyond the grid the outermost cells go on, as the slicer has it.
        const cz = Math.min(grid.nz - 1, Math.max(0, bz * edge + z - 1));
        for (let y = 0; y < paddedEdge; ++y) {
            const cy = Math.min(grid.ny - 1, Math.max(0, by * edge + y - 1));
            let to = 2 * (((z0 + z) * height + y0 + y) * width + x0);
            for (let x = 0; x < paddedEdge; ++x, to += 2) {
                const cx = Math.min(grid.nx - 1, Math.max(0, bx * edge + x - 1));
                const code = codeAt(grid, cx, cy, cz);
                if (code < firstValueCode) continue;
                atlas.texels[to] = shownOf[code]!;
                atlas.texels[to + 1] = 255;
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

// What was seen of each column, x fastest.
export function coverageOf(grid: PackedGrid): Uint8Array {
    const edge = grid.brickEdge;
    const coverage = new Uint8Array(grid.nx * grid.ny);
    for (let y = 0; y < grid.ny; ++y) {
        for (let x = 0; x < grid.nx; ++x) {
            for (let z = 0; z < grid.nz; ++z) {
                const brick = brickIndex(grid, Math.floor(x / edge), Math.floor(y / edge), Math.floor(z / edge));
                if (grid.kind[brick] === BrickKind.uniform && grid.state[brick] === 0) {
                    z = (Math.floor(z / edge) + 1) * edge - 1;
                    continue;
                }
                if (codeAt(grid, x, y, z) === 0) continue;
                coverage[y * grid.nx + x] = grid.levelsM[z]! < lowM ? Coverage.low : Coverage.high;
                break;
            }
        }
    }
    return coverage;
}
