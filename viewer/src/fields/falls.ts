// Computes the falls of a volume: in which direction and how steeply its values decrease. The light of the volume is
// computed from the falls. This file does the part of render/volume/shade_field.h that depends neither on the sun nor
// on the view, so falls are computed once for a grid. Cells are averaged over 2 x 2 columns, and smoothed along each
// axis by 1-4-6-4-1.
//
// Reflectivity counts from 0 dBZ, or from the lowest color of the table if that is lower, up to 60 dBZ. A value of any
// other moment counts as 30, and no echo as 0. Cells that were not seen, are range folded or ambiguous do not count. If
// no cell of an average counts, the average is copied from the level below, or at the bottom from the lowest level that
// has an average.

import { BrickKind, CellState, PackedGrid, valueOf } from '../wire/packed_grid';

export const fallCellsAcross = 2;
// Greatest difference between the two neighbors of a cell that a byte can hold. A byte b is a fall of c |c| times this
// difference, where c is (b - 128) / 127.
export const steepestFall = 64;

export interface Falls {
    size: [number, number, number]; // along x, y, z
    // Four bytes for each coarse cell, z fastest, then y, then x. They are the falls to the east, to the north and
    // upward, and 255 if the smoothed value is above 0, else 0.
    bytes: Uint8Array;
}

const highest = 60;
const valueOfOthers = 30;
const weights = [1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16] as const;

function valuesOfCodes(grid: PackedGrid, moment: string, lowestColor: number): Float32Array {
    const values = new Float32Array(grid.codeBytes === 1 ? 256 : 65536);
    const zero = Math.min(0, lowestColor);
    for (let code = grid.firstCode; code < values.length; ++code) {
        values[code] =
            moment === 'REF' ? Math.min(highest - zero, Math.max(0, valueOf(grid, code) - zero)) : valueOfOthers;
    }
    return values;
}

// Adds a column of the grid to the sums and counts of its coarse column, level by level.
function addColumn(
    grid: PackedGrid,
    values: Float32Array,
    x: number,
    y: number,
    sums: Float32Array,
    counts: Float32Array,
): void {
    const edge = grid.brickEdge;
    for (let bz = 0; bz < grid.bricks[2]; ++bz) {
        const brick = (Math.floor(x / edge) * grid.bricks[1] + Math.floor(y / edge)) * grid.bricks[2] + bz;
        const kind = grid.kind[brick];
        if (kind === BrickKind.uniform && grid.state[brick] !== CellState.noEcho) continue;
        const from = grid.block[brick]! * edge ** 3 + ((x % edge) * edge + (y % edge)) * edge;
        const depth = Math.min(edge, grid.nz - bz * edge);
        for (let z = 0; z < depth; ++z) {
            let code: number = CellState.noEcho;
            if (kind === BrickKind.codes) code = grid.codes[from + z]!;
            else if (kind === BrickKind.states) code = (grid.states[(from + z) >> 2]! >> (2 * ((from + z) & 3))) & 3;
            if (code !== CellState.noEcho && code < grid.firstCode) continue;
            sums[bz * edge + z]! += values[code]!;
            counts[bz * edge + z]! += 1;
        }
    }
}

function fillHoles(means: Float32Array, counts: Float32Array): void {
    const first = counts.findIndex((count) => count > 0);
    if (first < 0) return;
    means.fill(means[first]!, 0, first);
    for (let z = first + 1; z < means.length; ++z) if (counts[z] === 0) means[z] = means[z - 1]!;
}

// Smooths rows of `count` numbers that are `stride` apart. `starts` visits the first index of each row.
function smooth(
    values: Float32Array,
    count: number,
    stride: number,
    starts: (visit: (from: number) => void) => void,
): void {
    const row = new Float32Array(count + 4);
    starts((from) => {
        for (let i = 0; i < count; ++i) row[i + 2] = values[from + i * stride]!;
        row[0] = row[1] = row[2]!;
        row[count + 2] = row[count + 3] = row[count + 1]!;
        for (let i = 0; i < count; ++i) {
            values[from + i * stride] =
                weights[0] * (row[i]! + row[i + 4]!) +
                weights[1] * (row[i + 1]! + row[i + 3]!) +
                weights[2] * row[i + 2]!;
        }
    });
}

function smoothedValues(
    grid: PackedGrid,
    moment: string,
    lowestColor: number,
    [nx, ny, nz]: Falls['size'],
): Float32Array {
    const ofCode = valuesOfCodes(grid, moment, lowestColor);
    const values = new Float32Array(nx * ny * nz);
    const counts = new Float32Array(nz);
    for (let x = 0; x < nx; ++x) {
        for (let y = 0; y < ny; ++y) {
            const sums = values.subarray((x * ny + y) * nz, (x * ny + y + 1) * nz);
            counts.fill(0);
            for (let ix = 2 * x; ix < Math.min(2 * x + 2, grid.nx); ++ix) {
                for (let iy = 2 * y; iy < Math.min(2 * y + 2, grid.ny); ++iy)
                    addColumn(grid, ofCode, ix, iy, sums, counts);
            }
            for (let z = 0; z < nz; ++z) sums[z] = sums[z]! / Math.max(1, counts[z]!);
            fillHoles(sums, counts);
        }
    }
    smooth(values, nz, 1, (visit) => {
        for (let at = 0; at < values.length; at += nz) visit(at);
    });
    smooth(values, ny, nz, (visit) => {
        for (let x = 0; x < nx; ++x) for (let z = 0; z < nz; ++z) visit(x * ny * nz + z);
    });
    smooth(values, nx, ny * nz, (visit) => {
        for (let at = 0; at < ny * nz; ++at) visit(at);
    });
    return values;
}

function byteOf(fall: number): number {
    const root = Math.min(1, Math.sqrt(Math.abs(fall) / steepestFall));
    return Math.round(128 + 127 * Math.sign(fall) * root);
}

export function fallOf(byte: number): number {
    const root = (byte - 128) / 127;
    return root * Math.abs(root) * steepestFall;
}

export function fallsOf(grid: PackedGrid, moment: string, lowestColor: number): Falls {
    const size: Falls['size'] = [Math.ceil(grid.nx / fallCellsAcross), Math.ceil(grid.ny / fallCellsAcross), grid.nz];
    const [nx, ny, nz] = size;
    const values = smoothedValues(grid, moment, lowestColor, size);
    const bytes = new Uint8Array(4 * values.length).fill(128);
    const column = (x: number, y: number) =>
        (Math.min(nx - 1, Math.max(0, x)) * ny + Math.min(ny - 1, Math.max(0, y))) * nz;
    for (let x = 0; x < nx; ++x) {
        for (let y = 0; y < ny; ++y) {
            const [here, west, east, south, north] = [
                column(x, y),
                column(x - 1, y),
                column(x + 1, y),
                column(x, y - 1),
                column(x, y + 1),
            ];
            for (let z = 0; z < nz; ++z) {
                const at = 4 * (here + z);
                const hasEcho = values[here + z]! > 0;
                bytes[at + 3] = hasEcho ? 255 : 0;
                if (!hasEcho) continue;
                bytes[at] = byteOf(values[west + z]! - values[east + z]!);
                bytes[at + 1] = byteOf(values[south + z]! - values[north + z]!);
                bytes[at + 2] = byteOf(values[here + Math.max(0, z - 1)]! - values[here + Math.min(nz - 1, z + 1)]!);
            }
        }
    }
    return { size, bytes };
}
