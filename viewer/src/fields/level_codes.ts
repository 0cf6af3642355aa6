// Returns the codes of one level of a grid, x fastest.

import { BrickKind, PackedGrid } from '../wire/packed_grid';

export function levelCodes(grid: PackedGrid, level: number, codes = new Uint16Array(grid.nx * grid.ny)): Uint16Array {
    const edge = grid.brickEdge;
    const [bz, z] = [Math.floor(level / edge), level % edge];
    for (let bx = 0; bx < grid.bricks[0]; ++bx) {
        for (let by = 0; by < grid.bricks[1]; ++by) {
            const brick = (bx * grid.bricks[1] + by) * grid.bricks[2] + bz;
            const kind = grid.kind[brick];
            const [lastX, lastY] = [Math.min(edge, grid.nx - bx * edge), Math.min(edge, grid.ny - by * edge)];
            for (let y = 0; y < lastY; ++y) {
                const to = (by * edge + y) * grid.nx + bx * edge;
                if (kind === BrickKind.uniform) {
                    codes.fill(grid.state[brick]!, to, to + lastX);
                    continue;
                }
                let from = grid.block[brick]! * edge ** 3 + y * edge + z;
                for (let x = 0; x < lastX; ++x, from += edge * edge) {
                    codes[to + x] =
                        kind === BrickKind.codes
                            ? grid.codes[from]!
                            : (grid.states[from >> 2]! >> (2 * (from & 3))) & 3;
                }
            }
        }
    }
    return codes;
}
