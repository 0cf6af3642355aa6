// Decides whether a grid of reflectivity shows clear air: it has echo, but column maxima reach 20 dBZ on less than 150
// km2, and 30 dBZ on less than 60 km2 (render/view/echo_outline.h). In a grid that was halved n times, a cell has the
// greatest value of 4^n cells. The function then estimates the areas, and counts each cell as 2^n cells.

import { cellSizeM } from '../earth/projection';
import { BrickKind, PackedGrid, firstValueCode, valueOf } from '../wire/packed_grid';

const limits = [
    { dbz: 20, km2: 150 },
    { dbz: 30, km2: 60 },
];

// Returns true for clear air. Stops as soon as an area reaches its limit, which in a storm takes a few bricks.
export function isClearAir(grid: PackedGrid): boolean {
    const [width, height] = cellSizeM(grid);
    const cellKm2 = (width * height) / 1e6 / 2 ** grid.halvings;
    const edge = grid.brickEdge;
    const leastCodes = limits.map(
        ({ dbz }) => firstValueCode + Math.ceil((dbz - valueOf(grid, firstValueCode)) / grid.step),
    );
    const reached = new Uint8Array(grid.nx * grid.ny); // how many of the limits a column reaches
    const km2 = [0, 0];
    let hasEcho = false;
    for (let brick = 0; brick < grid.kind.length; ++brick) {
        if (grid.kind[brick] !== BrickKind.codes) continue;
        hasEcho = true;
        if (grid.greatestCode[brick]! < leastCodes[0]!) continue;
        const column = Math.floor(brick / grid.bricks[2]);
        const [x0, y0] = [Math.floor(column / grid.bricks[1]) * edge, (column % grid.bricks[1]) * edge];
        const from = grid.block[brick]! * edge ** 3;
        for (let i = 0; i < edge ** 3; ++i) {
            const code = grid.codes[from + i]!;
            if (code < leastCodes[0]!) continue;
            const at = (y0 + (Math.floor(i / edge) % edge)) * grid.nx + x0 + Math.floor(i / edge ** 2);
            while (reached[at]! < limits.length && code >= leastCodes[reached[at]!]!) km2[reached[at]!++]! += cellKm2;
        }
        if (limits.some((limit, i) => km2[i]! >= limit.km2)) return false;
    }
    return hasEcho;
}
