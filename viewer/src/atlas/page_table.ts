// Makes the indirection of a grid in parts (atlas.ts). It gives each brick of the grid the slot of a brick in the atlas
// that covers it: the finest such brick.

import { pageEntry, putReaches } from './atlas';
import { Pyramid } from './pyramid';

// A column of bricks in the atlas, at a level (number of halvings). `slots` has the slot of each brick, from the
// bottom; -1 for a brick without values.
export interface ResidentColumn {
    level: number;
    x: number;
    y: number;
    slots: Int32Array;
}

// A sample in a brick that was halved n times uses cells at most 1.5 x 2^n cells of the grid away. A brick that was
// halved n - 3 times is 2 x 2^n cells wide. So the bound over such a brick and its neighbors holds for all cells that
// the sample uses.
const finerBy = 3;

// Fills `entries`, one for each brick of the grid, x fastest. `shownOf` has the shown code of each code.
export function paintPages(
    entries: Uint32Array,
    pyramid: Pyramid,
    columns: Iterable<ResidentColumn>,
    shownOf: Uint8Array,
): void {
    const [bx, by] = pyramid.levels[0]!.columns;
    const { layers } = pyramid;
    entries.fill(0);
    const coarsestFirst = [...columns].sort((one, other) => other.level - one.level);
    for (const { level, x, y, slots } of coarsestFirst) {
        const near = Math.max(0, level - finerBy);
        const { about, columns: nearColumns } = pyramid.levels[near]!;
        const [endX, endY] = [Math.min(bx, (x + 1) << level), Math.min(by, (y + 1) << level)];
        for (let fx = x << level; fx < endX; ++fx) {
            for (let fy = y << level; fy < endY; ++fy) {
                const from = ((fx >> near) * nearColumns[1] + (fy >> near)) * layers;
                for (let z = 0; z < layers; ++z) {
                    const greatest = about[from + z]!;
                    const slot = slots[z]!;
                    entries[(z * by + fy) * bx + fx] =
                        greatest === 0 || slot < 0 ? 0 : pageEntry(slot, shownOf[greatest]!, level);
                }
            }
        }
    }
    putReaches(entries, [bx, by, layers]);
}
