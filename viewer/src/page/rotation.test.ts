import assert from 'node:assert/strict';
import test from 'node:test';

import { Made, evenLevels, packedGrid } from '../testing/written_grid';
import { leastRotation } from '../scene/layers';
import { CellState, PackedGrid, codeAt, readPackedGrid, stateOf, valueOf } from '../wire/packed_grid';
import { columnCells, leastDepthM, rotationGrid, rotationOf } from './rotation';

const azsh = 9;
const [nx, ny, nz] = [40, 36, 20];
const codeOf = (value: number) => 3 + (value + 128) * 32;

// Returns a grid of azimuthal shear in 0.001/s, 500 m from level to level. The functions return null without a value.
function gridOf(shearAt: (x: number, y: number, z: number) => number | null): PackedGrid {
    const made: Made = {
        nx,
        ny,
        levelsM: evenLevels(nz),
        moment: azsh,
        codeBytes: 2,
        firstValue: -128,
        step: 1 / 32,
        codeOf: (x, y, z) => {
            const shear = shearAt(x, y, z);
            return shear === null ? 1 : codeOf(shear);
        },
    };
    return readPackedGrid(packedGrid(made));
}
const share = (grid: PackedGrid, x: number, y: number, z: number) => {
    const code = codeAt(grid, x, y, z);
    return stateOf(grid, code) === CellState.value ? valueOf(grid, code) : null;
};
const levelsOfDepth = Math.ceil(leastDepthM / (evenLevels(2)[1]! - evenLevels(2)[0]!));

test('strong cells above each other make a column, which has their sense of rotation', () => {
    const grid = gridOf((x, y) => (x === 10 && y === 12 ? leastRotation : x === 30 && y === 5 ? -20 : 1));
    const cells = [...columnCells(grid).values()];
    assert.equal(cells.length, 2 * nz);
    for (const { cell, sense } of cells) assert.deepEqual(cell.slice(0, 2), sense > 0 ? [10, 12] : [30, 5]);
    const made = rotationGrid(grid);
    // Half of the weight along each axis is on the cell itself; along the column, all of it is in the column.
    assert.ok(Math.abs(share(made, 10, 12, 9)! - 0.25) < 0.006);
    assert.ok(Math.abs(share(made, 30, 5, 9)! + 0.25) < 0.006);
    assert.ok(Math.abs(share(made, 11, 12, 9)! - 0.125) < 0.006);
    assert.equal(share(made, 12, 12, 9), 0);
    assert.equal(codeAt(made, 20, 20, 9), CellState.noEcho);
});

test('weak, single or shallow cells make no column, and cells of opposite senses make no common column', () => {
    assert.equal(columnCells(gridOf((x, y) => (x === 10 && y === 12 ? leastRotation - 0.1 : 0))).size, 0);
    assert.equal(columnCells(gridOf((x, y, z) => ((x + y + z) % 7 === 0 && z === 4 ? 50 : 0))).size, 0);
    const deep = (levels: number) =>
        columnCells(gridOf((x, y, z) => (x === 10 && y === 12 && z >= 3 && z < 3 + levels ? 30 : 0))).size;
    assert.equal(deep(levelsOfDepth), 0);
    assert.equal(deep(levelsOfDepth + 1), levelsOfDepth + 1);
    const alternating = gridOf((x, y, z) => (x === 10 && y === 12 ? (z % 2 === 0 ? 30 : -30) : 0));
    assert.equal(columnCells(alternating).size, 0);
});

test('ambiguous cells and cells without a value are no rotation', () => {
    const bytes: Made = {
        nx,
        ny,
        levelsM: evenLevels(nz),
        moment: azsh,
        codeBytes: 2,
        firstValue: -128,
        step: 1 / 32,
        codeOf: (x) => [0, 1, 2, 3][x % 4]!,
    };
    const grid = readPackedGrid(packedGrid(bytes));
    assert.equal(columnCells(grid).size, 0);
    const made = rotationOf({ grid, coverage: new Uint8Array(0), stream: null } as unknown as Parameters<
        typeof rotationOf
    >[0]);
    assert.equal(made.atlas.brickCount, 0);
});

test('a leaning column at the edge of the grid is whole, and takes few bricks', () => {
    const grid = gridOf((x, y, z) => (y === 0 && x === Math.floor(z / 2) ? 12 : 0));
    assert.equal(columnCells(grid).size, nz);
    const { grid: made, atlas } = rotationOf({
        grid,
        coverage: new Uint8Array(0),
        stream: null,
    } as unknown as Parameters<typeof rotationOf>[0]);
    assert.ok(share(made, 0, 0, 0)! > 0);
    assert.ok(atlas.brickCount > 0 && atlas.brickCount < made.kind.length / 2);
});
