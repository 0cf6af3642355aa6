// Makes the indirection of a grid whose bricks come at several levels: each brick of the grid gets the finest one that
// is here.

import { pageEntry, putReaches } from './atlas';
import { Pyramid } from './pyramid';

// Bricks of one column of a level, from the bottom; a slot of -1 stands for a brick without values.
export interface ResidentColumn {
    level: number;
    x: number;
    y: number;
    slots: Int32Array;
}

// A sample of a brick of level n takes cells that lie within 1.5 x 2^n cells of the grid: within the next
// brick of the level n - 3 on.
const finerBy = 3;

// Fills `entries`, x fastest. `shownOf`: the shown code of each code.
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
