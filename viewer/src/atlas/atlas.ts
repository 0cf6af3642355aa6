// Copies the bricks of a grid into one texture, the atlas. A brick with values has a slot with a border of its
// neighbors' cells, so that the hardware interpolates across bricks. A cell with a value has its code in R and 255 in
// G; any other cell has 0 in both. After interpolation R / G is the mean of the cells with values, so that no state
// becomes a value.
//
// The atlas has codes of eight bits (shown codes). Codes of two bytes are scaled to them by codeScale and codeOffset;
// readings use the exact codes of the packed grid.

import { BrickKind, PackedGrid, firstValueCode, mayHoldValues } from '../wire/packed_grid';

export const paddedEdge = 18;

// Packs an indirection word (see Atlas). `greatest` is the greatest shown code that a sample in the brick can use.
export function pageEntry(slot: number, greatest: number, halvings: number): number {
    return ((greatest << 24) | (halvings << 21) | (slot + 1)) >>> 0;
}

const slotBits = 0x1fffff;
const mostReach = 7;

// Returns the slot of a word of the indirection; -1 if the brick shows nothing.
export function slotOf(entry: number): number {
    return (entry & slotBits) - 1;
}

// For each column of bricks without a slot, finds how many columns away the nearest column with a slot is. Writes this
// distance into the column's words. The distance is 1 for a neighbor, and at most 7. A ray skips all nearer columns at
// once.
export function putReaches(indirection: Uint32Array, [bx, by, bz]: readonly [number, number, number]): void {
    const reach = new Uint8Array(bx * by).fill(mostReach);
    for (let i = 0; i < indirection.length; ++i) if (slotOf(indirection[i]!) >= 0) reach[i % (bx * by)] = 0;
    const take = (x: number, y: number, ways: readonly [number, number][]) => {
        for (const [dx, dy] of ways) {
            const [nx, ny] = [x + dx, y + dy];
            if (nx >= 0 && ny >= 0 && nx < bx && ny < by)
                reach[y * bx + x] = Math.min(reach[y * bx + x]!, reach[ny * bx + nx]! + 1);
        }
    };
    // The first pass looks at the neighbors that come before a column in row order. The second pass looks at the
    // neighbors that come after it.
    const before = [
        [-1, 0],
        [-1, -1],
        [0, -1],
        [1, -1],
    ] as [number, number][];
    const behind = before.map(([dx, dy]) => [-dx, -dy] as [number, number]);
    for (let y = 0; y < by; ++y) for (let x = 0; x < bx; ++x) take(x, y, before);
    for (let y = by - 1; y >= 0; --y) for (let x = bx - 1; x >= 0; --x) take(x, y, behind);
    for (let z = 0; z < bz; ++z) {
        for (let column = 0; column < bx * by; ++column) {
            if (reach[column]! > 0) indirection[z * bx * by + column] = (reach[column]! << 21) >>> 0;
        }
    }
}

// Returns the first texel of a slot.
export function placeOfSlot(slot: number, slots: readonly [number, number, number]): [number, number, number] {
    const [sx, sy] = slots;
    return [
        (slot % sx) * paddedEdge,
        (Math.floor(slot / sx) % sy) * paddedEdge,
        Math.floor(slot / (sx * sy)) * paddedEdge,
    ];
}

export interface Atlas {
    size: [number, number, number]; // number of texels along each axis
    slots: [number, number, number]; // number of slots, each of which holds a brick, along each axis
    brickCount: number; // number of bricks in the atlas
    texels: Uint8Array; // RG, x fastest
    // One word for each brick of the grid, x fastest. Bits 0 to 20 have the number of the brick's slot plus 1, or 0
    // without a slot. Bits 21 to 23 have the number of halvings of the brick in the slot. Without a slot, they have the
    // distance that putReaches() writes, or 0. Bits 24 to 31 have an upper bound of the shown codes that a sample in
    // the brick can use.
    indirection: Uint32Array;
    bricks: [number, number, number];
    // code = codeOffset + codeScale * shown code
    codeScale: number;
    codeOffset: number;
    least: number; // least code of a value; without values it is above `greatest`
    greatest: number;
    // Number of values of each shown code.
    histogram: Uint32Array;
    // Greatest shown code of the cells that a sample in each block of each slot can use, x fastest. Empty for
    // a grid in parts.
    blocks: Uint8Array;
}

export const blockEdge = 4; // width of a block, in cells
export const blocksAlong = 4; // number of blocks along an axis of a brick
export const blocksABrick = blocksAlong ** 3;

// Along an axis, a texel belongs to the block of its cell. The first texel of a block also belongs to the previous
// block, because a sample between two cells uses both. No sample uses the border before the slot's own cells.
const firstBlock = Uint8Array.from({ length: paddedEdge }, (_, texel) => Math.max(0, (texel - 2) >> 2));
const lastBlock = Uint8Array.from({ length: paddedEdge }, (_, texel) => Math.min(blocksAlong - 1, (texel - 1) >> 2));

// Writes the greatest shown code of each block of a slot into `blocks`, from index `to` on, where `blocks` must be 0.
// `corner` is the index of the slot's first texel.
export function measureBlocks(
    { texels, width, height }: Pick<Filling, 'texels' | 'width' | 'height'>,
    corner: number,
    blocks: Uint8Array,
    to: number,
): void {
    for (let z = 1; z < paddedEdge; ++z) {
        for (let y = 1; y < paddedEdge; ++y) {
            const row = corner + 2 * (z * height + y) * width;
            for (let block = 0; block < blocksAlong; ++block) {
                let greatest = 0;
                const end = row + 2 * (blockEdge * block + blockEdge + 1);
                for (let at = end - 2 * blockEdge; at <= end; at += 2)
                    if (texels[at]! > greatest) greatest = texels[at]!;
                if (greatest === 0) continue;
                for (let bz = firstBlock[z]!; bz <= lastBlock[z]!; ++bz) {
                    for (let by = firstBlock[y]!; by <= lastBlock[y]!; ++by) {
                        const at = to + (bz * blocksAlong + by) * blocksAlong + block;
                        if (blocks[at]! < greatest) blocks[at] = greatest;
                    }
                }
            }
        }
    }
}

export function brickIndex(grid: PackedGrid, x: number, y: number, z: number): number {
    return (x * grid.bricks[1] + y) * grid.bricks[2] + z;
}

// Returns the greatest code of a value in a brick and in its seven next neighbors along x, y and z, because a sample in
// the brick uses their first cells; 0 without values.
function greatestAbout(grid: PackedGrid, x: number, y: number, z: number): number {
    let greatest = 0;
    for (let dx = 0; dx < 2; ++dx) {
        for (let dy = 0; dy < 2; ++dy) {
            for (let dz = 0; dz < 2; ++dz) {
                if (x + dx >= grid.bricks[0] || y + dy >= grid.bricks[1] || z + dz >= grid.bricks[2]) continue;
                const brick = brickIndex(grid, x + dx, y + dy, z + dz);
                if (!mayHoldValues(grid, brick)) continue;
                greatest = Math.max(greatest, grid.greatestCode[brick]!);
            }
        }
    }
    return greatest;
}

// Returns the least code of a value in a brick; Infinity if the brick also has ambiguous cells and its codes are not
// here, because the table does not tell the least value of such a brick.
function leastOf(grid: PackedGrid, brick: number): number {
    if (grid.leastCode[brick]! >= grid.firstCode) return grid.leastCode[brick]!;
    if (grid.codes.length === 0) return Infinity;
    const from = grid.block[brick]! * grid.brickEdge ** 3;
    let least = Infinity;
    for (let i = from; i < from + grid.brickEdge ** 3; ++i) {
        const code = grid.codes[i]!;
        if (code >= grid.firstCode && code < least) least = code;
    }
    return least;
}

// Returns the least and the greatest code of a value; the first is above the second if there is no value. The table of
// a grid in parts does not tell the least value of a brick with ambiguous cells. The range then reaches as far below
// zero as the greatest value is above it, because values of derived moments are signed.
export function rangeOfCodes(grid: PackedGrid): [number, number] {
    let [least, greatest] = [65535, 0];
    let isUnsure = false;
    for (let i = 0; i < grid.kind.length; ++i) {
        if (!mayHoldValues(grid, i)) continue;
        const leastHere = leastOf(grid, i);
        isUnsure ||= leastHere === Infinity;
        least = Math.min(least, leastHere);
        greatest = Math.max(greatest, grid.greatestCode[i]!);
    }
    if (isUnsure) {
        const zero = firstValueCode - grid.firstValue / grid.step;
        least = Math.max(grid.firstCode, Math.min(least, Math.floor(2 * zero - greatest)));
    }
    return [least, greatest];
}

// Returns the number of slots along each axis of a texture that is nearly a cube and holds `count` slots.
function slotsFor(count: number, mostTexels: number): [number, number, number] {
    const most = Math.floor(mostTexels / paddedEdge);
    const side = Math.min(most, Math.max(1, Math.ceil(Math.cbrt(count))));
    const rows = Math.min(most, Math.max(1, Math.ceil(count / (side * side))));
    if (side * side * rows >= count) return [side, side, rows];
    return [most, most, Math.ceil(count / (most * most))];
}

// Returns the codes of a brick, which begin at index `from`; null if the brick has no values or its codes are not here.
export type CellsOf = (brick: number) => { codes: Uint8Array | Uint16Array; from: number } | null;

// Source of the bricks of a grid, and the texels to which they are copied.
export interface Filling {
    grid: PackedGrid; // only its table is read
    cellsOf: CellsOf;
    shownOf: Uint8Array; // shown code of each code of a value
    texels: Uint8Array;
    width: number; // width of the texture, in texels
    height: number;
}

// A run of cells along an axis that a slot takes from one brick of the grid.
interface Run {
    brick: number;
    from: number; // the first cell in that brick
    to: number; // its place in the slot
    count: number;
}

// Returns the runs of the cells [edge b - 1, edge b + 17) along an axis. Cells beyond the grid repeat its outermost
// cells, as in the slicer.
function runsAlong(b: number, edge: number, cells: number): Run[] {
    const runs: Run[] = [];
    for (let i = 0; i < paddedEdge; ++i) {
        const cell = Math.min(cells - 1, Math.max(0, b * edge + i - 1));
        const brick = Math.floor(cell / edge);
        const last = runs[runs.length - 1];
        if (last?.brick === brick && last.from + last.count === cell - brick * edge) ++last.count;
        else runs.push({ brick, from: cell - brick * edge, to: i, count: 1 });
    }
    return runs;
}

// Copies the values of the cells that a slot takes from one brick. `corner` is the index of the slot's first texel.
// Returns true if any of the cells has a value.
function copyRuns(
    filling: Filling,
    cells: { codes: Uint8Array | Uint16Array; from: number },
    corner: number,
    rows: [Run, Run, Run],
): boolean {
    const { grid, shownOf, texels, width, height } = filling;
    const [xs, ys, zs] = rows;
    const edge = grid.brickEdge;
    const { codes } = cells;
    let hasValues = false;
    // Write texels in memory order. The order of reads does not matter, because a brick fits into the cache.
    for (let z = 0; z < zs.count; ++z) {
        for (let y = 0; y < ys.count; ++y) {
            let from = cells.from + (xs.from * edge + ys.from + y) * edge + zs.from + z;
            let to = corner + 2 * (((zs.to + z) * height + ys.to + y) * width + xs.to);
            for (let x = 0; x < xs.count; ++x, from += edge * edge, to += 2) {
                const code = codes[from]!;
                if (code < grid.firstCode) continue;
                texels[to] = shownOf[code]!;
                texels[to + 1] = 255;
                hasValues = true;
            }
        }
    }
    return hasValues;
}

// Copies the values of a brick, and of one cell of its neighbors on each side, into the slot whose first texel has the
// index `corner`. Texels of cells without values stay as they were. Returns true if the slot got any value.
export function fillSlot(filling: Filling, bx: number, by: number, bz: number, corner: number): boolean {
    const { grid } = filling;
    const edge = grid.brickEdge;
    let hasValues = false;
    const [xs, ys, zs] = [runsAlong(bx, edge, grid.nx), runsAlong(by, edge, grid.ny), runsAlong(bz, edge, grid.nz)];
    for (const x of xs) {
        for (const y of ys) {
            for (const z of zs) {
                const cells = filling.cellsOf(brickIndex(grid, x.brick, y.brick, z.brick));
                if (cells && copyRuns(filling, cells, corner, [x, y, z])) hasValues = true;
            }
        }
    }
    return hasValues;
}

export interface ShownCodes {
    table: Uint8Array; // shown code of each code
    scale: number; // code = offset + scale * shown code
    offset: number;
}

export function shownCodes(grid: PackedGrid, least: number, greatest: number): ShownCodes {
    const table = new Uint8Array(65536);
    const isExact = grid.codeBytes === 1;
    const scale = isExact ? 1 : Math.max(1, (greatest - least) / 252);
    const offset = isExact ? 0 : least - firstValueCode * scale;
    for (let code = firstValueCode; code < table.length; ++code) {
        table[code] = Math.min(255, Math.max(firstValueCode, Math.round((code - offset) / scale)));
    }
    return { table, scale, offset };
}

// Counts the values of each shown code.
export function histogramOf(grid: PackedGrid, shownOf: Uint8Array): Uint32Array {
    const histogram = new Uint32Array(256);
    const cells = grid.brickEdge ** 3;
    for (let brick = 0; brick < grid.kind.length; ++brick) {
        if (grid.kind[brick] !== BrickKind.codes) continue;
        const from = grid.block[brick]! * cells;
        for (let i = from; i < from + cells; ++i) {
            const code = grid.codes[i]!;
            if (code >= grid.firstCode) ++histogram[shownOf[code]!]!;
        }
    }
    return histogram;
}

// Makes the atlas of a whole grid. `mostTexels` is the greatest side of a 3D texture on this device. Throws a
// RangeError if the grid needs a larger texture.
export function makeAtlas(grid: PackedGrid, mostTexels: number): Atlas {
    const [least, greatest] = rangeOfCodes(grid);
    const shown = shownCodes(grid, least, greatest);
    const [bx, by, bz] = grid.bricks;
    const wanted: [number, number, number][] = [];
    for (let z = 0; z < bz; ++z) {
        for (let y = 0; y < by; ++y) {
            for (let x = 0; x < bx; ++x) {
                if (greatestAbout(grid, x, y, z) > 0) wanted.push([x, y, z]);
            }
        }
    }
    const slots = slotsFor(wanted.length, mostTexels);
    const size = slots.map((n) => n * paddedEdge) as [number, number, number];
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
        histogram: histogramOf(grid, shown.table),
        blocks: new Uint8Array(blocksABrick * wanted.length),
    };
    const cellCount = grid.brickEdge ** 3;
    const cellsOf: CellsOf = (brick) =>
        grid.kind[brick] === BrickKind.codes ? { codes: grid.codes, from: grid.block[brick]! * cellCount } : null;
    const filling: Filling = {
        grid,
        cellsOf,
        shownOf: shown.table,
        texels: atlas.texels,
        width: size[0],
        height: size[1],
    };
    wanted.forEach(([x, y, z], slot) => {
        const [px, py, pz] = placeOfSlot(slot, slots);
        const corner = 2 * ((pz * size[1] + py) * size[0] + px);
        fillSlot(filling, x, y, z, corner);
        const [from, to] = [blocksABrick * slot, blocksABrick * (slot + 1)];
        measureBlocks(filling, corner, atlas.blocks, from);
        const greatest = atlas.blocks.subarray(from, to).reduce((most, one) => Math.max(most, one), 0);
        if (greatest > 0) atlas.indirection[(z * by + y) * bx + x] = pageEntry(slot, greatest, 0);
    });
    putReaches(atlas.indirection, atlas.bricks);
    return atlas;
}

export const enum Coverage {
    notSeen = 0, // no cell of the column was seen
    high = 1, // seen, but from above 3 km only
    low = 2, // seen from below 3 km
}
const lowM = 3000;

// Lowers `lowest`, the lowest seen level of each column, in the columns where this brick has a lower seen cell.
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
            else if (kind === BrickKind.states)
                while (z < depth && ((grid.states[(from + z) >> 2]! >> (2 * ((from + z) & 3))) & 3) === 0) ++z;
            if (z < depth) lowest[column] = Math.min(lowest[column]!, bz * edge + z);
        }
    }
}

// Returns the coverage of each column, x fastest.
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
