import assert from 'node:assert/strict';
import test from 'node:test';

import { ViewGeometry, usualCamera } from '../camera/geometry';
import { Ray } from '../camera/ray';
import { Cells, boxOf } from './grid_box';
import { firstVisible, mostVisible } from './first_visible';
import { cellSizeM } from '../earth/projection';
import { codeAt, firstValueCode, readPackedGrid, valueOf } from '../wire/packed_grid';
import { slantedGrid } from '../testing/written_grid';

const grid = readPackedGrid(slantedGrid(40, 36, 20));
const { halfXM, halfYM, bottomM, topM } = boxOf(grid);
const box = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
const cells: Cells = { grid, middle: [0, 0] };
const all = () => true;

test('from straight above, the highest value of the column comes first', () => {
    const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, tiltDeg: 0 }, 2, 400, 400);
    const [width, height] = cellSizeM(grid);
    let read = 0;
    for (let x = 0; x < grid.nx; ++x) {
        for (let y = 0; y < grid.ny; ++y) {
            const at: [number, number] = [(x + 0.5 - grid.nx / 2) * width, (y + 0.5 - grid.ny / 2) * height];
            const pixel = geometry.project([at[0], at[1], 0])!;
            let level = grid.nz - 1;
            while (level >= 0 && codeAt(grid, x, y, level) < firstValueCode) --level;
            const seen = firstVisible(cells, new Ray(geometry, ...pixel), box, all);
            assert.equal(seen?.value ?? null, level < 0 ? null : valueOf(grid, codeAt(grid, x, y, level)));
            if (seen) assert.equal(seen.heightM, grid.levelsM[level]);
            if (seen) ++read;
        }
    }
    assert.ok(read > 100);
});

test('a ray passes cells that are not visible or outside of the box', () => {
    for (const camera of [usualCamera, { ...usualCamera, fieldOfViewDeg: 40, tiltDeg: 70, azimuthDeg: 30 }]) {
        const geometry = new ViewGeometry(boxOf(grid), camera, 2, 400, 400);
        const least = valueOf(grid, 80);
        const half = { ...box, eastM: 0 };
        let [passed, cut] = [0, 0];
        for (let x = 10; x < 400; x += 13) {
            for (let y = 10; y < 400; y += 13) {
                const ray = new Ray(geometry, x, y);
                const seen = firstVisible(cells, ray, box, all);
                const strong = firstVisible(cells, ray, box, (value) => value >= least);
                if (strong) assert.ok(strong.value >= least);
                if (strong && seen && strong.at[0] !== seen.at[0]) ++passed;
                const west = firstVisible(cells, ray, half, all);
                if (west) assert.ok(west.at[0] <= 0);
                if (west && seen && seen.at[0] > 0) ++cut;
            }
        }
        assert.ok(passed > 5 && cut >= 0);
        assert.equal(firstVisible(cells, new Ray(geometry, -5000, -5000), box, all), null);
    }
});

test('a reading of the volume takes the cell that contributes most (2026-11-28: it took the first cell, which nobody sees)', () => {
    const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, tiltDeg: 0 }, 2, 400, 400);
    const [width, height] = cellSizeM(grid);
    const strong = valueOf(grid, 80);
    const perM = (value: number) => (value >= strong ? 1e-3 : 1e-7);
    let below = 0;
    for (let x = 1; x < grid.nx; x += 3) {
        for (let y = 1; y < grid.ny; y += 3) {
            const pixel = geometry.project([(x + 0.5 - grid.nx / 2) * width, (y + 0.5 - grid.ny / 2) * height, 0])!;
            const ray = new Ray(geometry, ...pixel);
            const { cell, share, through } = mostVisible(cells, ray, box, Infinity, perM);
            const column = Array.from({ length: grid.nz }, (_, z) => codeAt(grid, x, y, z));
            const top = column
                .map((code, z) => (code >= firstValueCode && valueOf(grid, code) >= strong ? z : -1))
                .reduce((a, b) => Math.max(a, b), -1);
            if (top < 0) continue;
            assert.equal(cell?.value, valueOf(grid, column[top]!));
            assert.equal(cell?.heightM, grid.levelsM[top]);
            // A level of 500 m is drawn 1000 m high, so a cell lets exp(-1) of the light through.
            assert.ok(
                Math.abs(share - (1 - Math.exp(-1))) < 0.15 && through <= 1 - share + 1e-9,
                `${share} ${through}`,
            );
            if (column.slice(top + 1).some((code) => code >= firstValueCode)) ++below;
        }
    }
    assert.ok(below > 5);
    // A solid layer before the volume hides all of it.
    const nothing = mostVisible(cells, new Ray(geometry, 200, 200), box, -Infinity, perM);
    assert.deepEqual([nothing.cell, nothing.through], [null, 1]);
});
