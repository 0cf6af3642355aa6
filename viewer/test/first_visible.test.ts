import assert from 'node:assert/strict';
import test from 'node:test';

import { ViewGeometry, usualCamera } from '../src/camera/geometry';
import { boxOf } from '../src/scene/grid_box';
import { firstVisible } from '../src/scene/first_visible';
import { cellSizeM } from '../src/scene/projection';
import { codeAt, firstValueCode, readPackedGrid, valueOf } from '../src/wire/packed_grid';
import { makeGrid } from './made_grid';

const grid = readPackedGrid(makeGrid(40, 36, 20).bytes);
const { halfXM, halfYM, bottomM, topM } = boxOf(grid);
const box = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
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
            const seen = firstVisible({ grid, middle: [0, 0] }, geometry, box, pixel[0], pixel[1], all);
            assert.equal(seen?.value ?? null, level < 0 ? null : valueOf(grid, codeAt(grid, x, y, level)));
            if (seen) assert.equal(seen.heightM, grid.levelsM[level]);
            if (seen) ++read;
        }
    }
    assert.ok(read > 100);
});

test('what is not visible, or lies outside of the box, is passed', () => {
    for (const camera of [usualCamera, { ...usualCamera, fieldOfViewDeg: 40, tiltDeg: 70, azimuthDeg: 30 }]) {
        const geometry = new ViewGeometry(boxOf(grid), camera, 2, 400, 400);
        const least = valueOf(grid, 80);
        const half = { ...box, eastM: 0 };
        let [passed, cut] = [0, 0];
        for (let x = 10; x < 400; x += 13) {
            for (let y = 10; y < 400; y += 13) {
                const seen = firstVisible({ grid, middle: [0, 0] }, geometry, box, x, y, all);
                const strong = firstVisible({ grid, middle: [0, 0] }, geometry, box, x, y, value => value >= least);
                if (strong) assert.ok(strong.value >= least);
                if (strong && seen && strong.at[0] !== seen.at[0]) ++passed;
                const west = firstVisible({ grid, middle: [0, 0] }, geometry, half, x, y, all);
                if (west) assert.ok(west.at[0] <= 0);
                if (west && seen && seen.at[0] > 0) ++cut;
            }
        }
        assert.ok(passed > 5 && cut >= 0);
        assert.equal(firstVisible({ grid, middle: [0, 0] }, geometry, box, -5000, -5000, all), null);
    }
});
