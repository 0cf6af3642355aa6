// Finds columns of rotation in a grid of azimuthal shear, and makes a grid whose surfaces are the columns.
//
// A column is a set of neighboring cells whose shear is at least `leastRotation` in one sense of rotation, and which is
// at least `leastDepthM` deep. So single cells of noise make no column. The made grid holds, for each cell about a
// column, the share of its neighborhood that belongs to a column (1-2-1 along each axis), negative if clockwise. The
// surface at `columnShare` is the column, rounded only for the eye.
//
// render/products/rotation.h has the same rules.

import { makeAtlas } from '../atlas/atlas';
import { LoadedGrid } from '../atlas/loaded_grid';
import { leastRotation } from '../scene/layers';
import { BrickKind, CellState, PackedGrid, codeAt, firstValueCode, mayHoldValues, valueOf } from '../wire/packed_grid';

export const leastDepthM = 2000;
const steps = 100; // of a share
const mostTexels = 256; // every device has textures of this size, and columns are few

type Cell = [number, number, number];

const indexOf = ({ nx, ny }: PackedGrid, [x, y, z]: Cell): number => (z * ny + y) * nx + x;

// Calls `act` for the neighbors of a cell up to a distance along each axis, and for the cell itself.
function around({ nx, ny, nz }: PackedGrid, [x, y, z]: Cell, reach: number, act: (cell: Cell) => void): void {
    for (let k = Math.max(0, z - reach); k <= Math.min(nz - 1, z + reach); ++k)
        for (let j = Math.max(0, y - reach); j <= Math.min(ny - 1, y + reach); ++j)
            for (let i = Math.max(0, x - reach); i <= Math.min(nx - 1, x + reach); ++i) act([i, j, k]);
}

// Returns the cells of strong rotation: 1 if counterclockwise, -1 if clockwise.
function strongCells(grid: PackedGrid): Map<number, { cell: Cell; sense: number }> {
    const { brickEdge: edge, bricks } = grid;
    const found = new Map<number, { cell: Cell; sense: number }>();
    for (let brick = 0; brick < grid.kind.length; ++brick) {
        if (!mayHoldValues(grid, brick)) continue;
        const first: Cell = [
            Math.floor(brick / (bricks[1] * bricks[2])) * edge,
            (Math.floor(brick / bricks[2]) % bricks[1]) * edge,
            (brick % bricks[2]) * edge,
        ];
        for (let z = first[2]; z < Math.min(first[2] + edge, grid.nz); ++z)
            for (let y = first[1]; y < Math.min(first[1] + edge, grid.ny); ++y)
                for (let x = first[0]; x < Math.min(first[0] + edge, grid.nx); ++x) {
                    const code = codeAt(grid, x, y, z);
                    if (code < grid.firstCode) continue;
                    const value = valueOf(grid, code);
                    if (Math.abs(value) < leastRotation) continue;
                    found.set(indexOf(grid, [x, y, z]), { cell: [x, y, z], sense: Math.sign(value) });
                }
    }
    return found;
}

// Returns the cells of columns, by their index, with their sense.
export function columnCells(grid: PackedGrid): Map<number, { cell: Cell; sense: number }> {
    const strong = strongCells(grid);
    const columns = new Map<number, { cell: Cell; sense: number }>();
    const seen = new Set<number>();
    for (const [start, one] of strong) {
        if (seen.has(start)) continue;
        seen.add(start);
        const members = [one];
        // The loop also visits the members that it adds.
        for (const member of members)
            around(grid, member.cell, 1, (cell) => {
                const index = indexOf(grid, cell);
                const other = strong.get(index);
                if (other?.sense !== one.sense || seen.has(index)) return;
                seen.add(index);
                members.push(other);
            });
        let [low, high] = [Infinity, -Infinity];
        for (const { cell } of members) {
            low = Math.min(low, grid.levelsM[cell[2]]!);
            high = Math.max(high, grid.levelsM[cell[2]]!);
        }
        if (high - low < leastDepthM) continue;
        for (const member of members) columns.set(indexOf(grid, member.cell), member);
    }
    return columns;
}

// Returns the grid of shares (see above).
export function rotationGrid(grid: PackedGrid): PackedGrid {
    const columns = columnCells(grid);
    const shares = new Map<number, { cell: Cell; share: number }>();
    for (const { cell, sense } of columns.values())
        around(grid, cell, 2, (near) => {
            const off = near.map((one, i) => Math.abs(one - cell[i]!));
            const weight = off.reduce((product, one) => product * (one === 0 ? 0.5 : one === 1 ? 0.25 : 0), 1);
            const index = indexOf(grid, near);
            const share = (shares.get(index)?.share ?? 0) + sense * weight;
            shares.set(index, { cell: near, share });
        });
    const { brickEdge: edge, bricks } = grid;
    const count = grid.kind.length;
    const made: PackedGrid = {
        ...grid,
        codeBytes: 1,
        firstCode: firstValueCode,
        firstValue: -1,
        step: 1 / steps,
        kind: new Uint8Array(count).fill(BrickKind.uniform),
        state: new Uint8Array(count).fill(CellState.noEcho),
        valueCount: new Uint16Array(count),
        leastCode: new Uint16Array(count),
        greatestCode: new Uint16Array(count),
        block: new Uint32Array(count),
        states: new Uint8Array(0),
    };
    const cells = edge ** 3;
    const blocks: Uint8Array[] = [];
    for (const { cell, share } of shares.values()) {
        const [bx, by, bz] = cell.map((one) => Math.floor(one / edge)) as Cell;
        const brick = (bx * bricks[1] + by) * bricks[2] + bz;
        if (made.kind[brick] === BrickKind.uniform) {
            made.kind[brick] = BrickKind.codes;
            made.block[brick] = blocks.length;
            made.leastCode[brick] = 255;
            blocks.push(new Uint8Array(cells).fill(CellState.noEcho));
        }
        const [x, y, z] = cell.map((one) => one % edge) as Cell;
        const code = firstValueCode + Math.round(steps * (1 + Math.max(-1, Math.min(1, share))));
        blocks[made.block[brick]!]![(x * edge + y) * edge + z] = code;
        ++made.valueCount[brick];
        made.leastCode[brick] = Math.min(made.leastCode[brick]!, code);
        made.greatestCode[brick] = Math.max(made.greatestCode[brick]!, code);
    }
    const codes = new Uint8Array(cells * blocks.length);
    blocks.forEach((block, i) => codes.set(block, i * cells));
    return { ...made, codes };
}

// Returns what the renderer draws as rotation.
export function rotationOf({ grid, coverage }: LoadedGrid): LoadedGrid {
    const made = rotationGrid(grid);
    return { grid: made, atlas: makeAtlas(made, mostTexels), coverage, stream: null };
}
