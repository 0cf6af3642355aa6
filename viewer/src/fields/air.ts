// Computes two shares of the air, as render/volume/haze.h does: air that was not seen, and range folded air. They are
// computed in coarse cells of 4 x 4 columns and 2 levels.

import { CellState, PackedGrid } from '../wire/packed_grid';
import { levelCodes } from './level_codes';

export const airCellsAcross = 4;
export const airCellsUp = 2;

export interface Air {
    size: [number, number, number]; // along x, y, z
    // Two bytes for each coarse cell, x fastest. They are the share of cells that were not seen and the share of range
    // folded cells, both of 255.
    shares: Uint8Array;
    hasFolded: boolean; // some cell is range folded
}

export function airOf(grid: PackedGrid): Air {
    const size: Air['size'] = [
        Math.ceil(grid.nx / airCellsAcross),
        Math.ceil(grid.ny / airCellsAcross),
        Math.ceil(grid.nz / airCellsUp),
    ];
    const air: Air = { size, shares: new Uint8Array(2 * size[0] * size[1] * size[2]), hasFolded: false };
    const layer = size[0] * size[1];
    const codes = new Uint16Array(grid.nx * grid.ny);
    for (let z = 0; z < size[2]; ++z) {
        const counts = new Uint16Array(3 * layer); // numbers of cells not seen, range folded, and in all
        for (let level = z * airCellsUp; level < Math.min(grid.nz, (z + 1) * airCellsUp); ++level) {
            levelCodes(grid, level, codes);
            for (let y = 0, at = 0; y < grid.ny; ++y) {
                const row = 3 * Math.floor(y / airCellsAcross) * size[0];
                for (let x = 0; x < grid.nx; ++x, ++at) {
                    const to = row + 3 * Math.floor(x / airCellsAcross);
                    if (codes[at] === CellState.notSeen) ++counts[to]!;
                    else if (codes[at] === CellState.rangeFolded) ++counts[to + 1]!;
                    ++counts[to + 2]!;
                }
            }
        }
        for (let i = 0; i < layer; ++i) {
            for (let kind = 0; kind < 2; ++kind)
                air.shares[2 * (z * layer + i) + kind] = Math.round((255 * counts[3 * i + kind]!) / counts[3 * i + 2]!);
            air.hasFolded ||= counts[3 * i + 1]! > 0;
        }
    }
    return air;
}
