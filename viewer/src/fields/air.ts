// How much of the air was not seen, and how much is range folded, in coarse cells of 4 x 4 columns and
// 2 levels, as render/volume/haze.h has it.

import { BrickKind, CellState, PackedGrid, codeAt } from '../wire/packed_grid';

export const airCellsAcross = 4;
export const airCellsUp = 2;

export interface Air {
    size: [number, number, number]; // along x, y, z
    // Of each coarse cell, x fastest: the shares of not seen and of range folded, 0 to 255.
    shares: Uint8Array;
}

function putShares(grid: PackedGrid, air: Air, x: number, y: number, z: number): void {
    const at = 2 * ((z * air.size[1] + y) * air.size[0] + x);
    const edge = grid.brickEdge;
    const brick =
        (Math.floor((x * airCellsAcross) / edge) * grid.bricks[1] + Math.floor((y * airCellsAcross) / edge)) * grid.bricks[2] +
        Math.floor((z * airCellsUp) / edge);
    if (grid.kind[brick] === BrickKind.uniform) {
        if (grid.state[brick] === CellState.notSeen) air.shares[at] = 255;
        if (grid.state[brick] === CellState.rangeFolded) air.shares[at + 1] = 255;
        return;
    }
    let [notSeen, folded, all] = [0, 0, 0];
    for (let ix = x * airCellsAcross; ix < Math.min((x + 1) * airCellsAcross, grid.nx); ++ix) {
        for (let iy = y * airCellsAcross; iy < Math.min((y + 1) * airCellsAcross, grid.ny); ++iy) {
            for (let iz = z * airCellsUp; iz < Math.min((z + 1) * airCellsUp, grid.nz); ++iz) {
                const code = codeAt(grid, ix, iy, iz);
                if (code === CellState.notSeen) ++notSeen;
                if (code === CellState.rangeFolded) ++folded;
                ++all;
            }
        }
    }
    air.shares[at] = Math.round((255 * notSeen) / all);
    air.shares[at + 1] = Math.round((255 * folded) / all);
}

export function airOf(grid: PackedGrid): Air {
    const size: Air['size'] = [Math.ceil(grid.nx / airCellsAcross), Math.ceil(grid.ny / airCellsAcross), Math.ceil(grid.nz / airCellsUp)];
    const air: Air = { size, shares: new Uint8Array(2 * size[0] * size[1] * size[2]) };
    for (let z = 0; z < size[2]; ++z) for (let y = 0; y < size[1]; ++y) for (let x = 0; x < size[0]; ++x) putShares(grid, air, x, y, z);
    return air;
}
