// Stores parts of a grid that is too large to be held as a whole: the tables of the grid and of its halved grids, and
// the codes of the columns of bricks that have come. Makes texels of these codes.

import { BrickKind, PackedBricks, PackedGrid } from '../wire/packed_grid';
import { Filling, ShownCodes, fillSlot, paddedEdge } from './atlas';

type Codes = Uint8Array | Uint16Array;

interface StoredLevel {
    grid: PackedGrid; // its table
    columns: Map<number, { codes: Codes; firstBlock: number }>;
}

export interface MadeColumn {
    level: number;
    x: number;
    y: number;
    hasValues: boolean[]; // for each brick of the column, from the bottom
    texels: Uint8Array; // 18 x 18 x 18 for each brick that has values, one brick after the other
}

export const brickTexelBytes = 2 * paddedEdge ** 3;

export class BrickStore {
    private levels = new Map<number, StoredLevel>();

    constructor(readonly shown: ShownCodes) {}

    // Takes the table of a level, and its codes if the grid is whole.
    addLevel(grid: PackedGrid): void {
        const level: StoredLevel = { grid, columns: new Map() };
        this.levels.set(grid.halvings, level);
        if (grid.codes.length > 0) this.addCodes(level, 0, grid.kind.length, 0, grid.codes);
    }

    addBricks(bricks: PackedBricks): void {
        const level = this.levels.get(bricks.halvings);
        if (level) this.addCodes(level, bricks.first, bricks.end, bricks.firstBlock, bricks.codes);
    }

    // Stores the codes of the bricks [first, end), whose first block has the number `firstBlock`. Blocks follow each
    // other in the order of the table, so the blocks of a column are one run.
    private addCodes(level: StoredLevel, first: number, end: number, firstBlock: number, codes: Codes): void {
        const { grid, columns } = level;
        const layers = grid.bricks[2];
        const cells = grid.brickEdge ** 3;
        let block = firstBlock;
        for (let column = first / layers; column < end / layers; ++column) {
            const from = block;
            for (let z = 0; z < layers; ++z) if (grid.kind[column * layers + z] === BrickKind.codes) ++block;
            if (block > from)
                columns.set(column, {
                    codes: codes.slice((from - firstBlock) * cells, (block - firstBlock) * cells),
                    firstBlock: from,
                });
        }
    }

    drop(levelNumber: number, x: number, y: number): void {
        const level = this.levels.get(levelNumber);
        level?.columns.delete(x * level.grid.bricks[1] + y);
    }

    // Makes the texels of a column. Where the codes of a neighbor are not here, its cells count as having no values.
    make(levelNumber: number, x: number, y: number): MadeColumn {
        const { grid, columns } = this.levels.get(levelNumber)!;
        const layers = grid.bricks[2];
        const cells = grid.brickEdge ** 3;
        const filling: Filling = {
            grid,
            cellsOf: (brick) => {
                if (grid.kind[brick] !== BrickKind.codes) return null;
                const column = columns.get(Math.floor(brick / layers));
                return column ? { codes: column.codes, from: (grid.block[brick]! - column.firstBlock) * cells } : null;
            },
            shownOf: this.shown.table,
            texels: new Uint8Array(brickTexelBytes),
            width: paddedEdge,
            height: paddedEdge,
        };
        const hasValues: boolean[] = [];
        const made: Uint8Array[] = [];
        for (let z = 0; z < layers; ++z) {
            const has = fillSlot(filling, x, y, z, 0);
            hasValues.push(has);
            if (!has) continue;
            made.push(filling.texels);
            filling.texels = new Uint8Array(brickTexelBytes);
        }
        const texels = new Uint8Array(made.length * brickTexelBytes);
        made.forEach((brick, i) => texels.set(brick, i * brickTexelBytes));
        return { level: levelNumber, x, y, hasValues, texels };
    }
}
