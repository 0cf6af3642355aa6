import assert from 'node:assert/strict';
import test from 'node:test';

import { makeAtlas } from './atlas';
import { countCodes, histogramOf } from './histogram';
import { codeAt, firstValueCode, readPackedGrid, valueOf } from '../wire/packed_grid';
import { slantedGrid } from '../testing/written_grid';

test('each value of the grid is counted once, in its column', () => {
    const grid = readPackedGrid(slantedGrid(20, 18, 17));
    const slow = new Map<number, number>();
    for (let x = 0; x < grid.nx; ++x) {
        for (let y = 0; y < grid.ny; ++y) {
            for (let z = 0; z < grid.nz; ++z) {
                const code = codeAt(grid, x, y, z);
                if (code >= firstValueCode) slow.set(code, (slow.get(code) ?? 0) + 1);
            }
        }
    }
    const atlas = makeAtlas(grid, 2048);
    const counts = countCodes(grid, atlas);
    assert(slow.size > 1);
    for (const [code, count] of slow) assert.equal(counts[code], count);
    const all = [...slow.values()].reduce((a, b) => a + b, 0);
    assert.equal(
        counts.reduce((a, b) => a + b, 0),
        all,
        'states are not counted',
    );
    const first = Math.min(...slow.keys());
    const low = valueOf(grid, first);
    const histogram = histogramOf(grid, counts, [low, low + 10 * grid.step], 8);
    assert.equal(histogram.length, 5, 'two codes a column');
    assert.equal(histogram[0], (slow.get(first) ?? 0) + (slow.get(first + 1) ?? 0));
    assert.equal(histogram[4], (slow.get(first + 8) ?? 0) + (slow.get(first + 9) ?? 0), 'values beyond are left out');
});

test('a grid without codes has the histogram of its shown codes', () => {
    for (const codeBytes of [1, 2] as const) {
        const grid = readPackedGrid(slantedGrid(20, 18, 17, codeBytes, codeBytes === 1 ? 1 : 30));
        const atlas = makeAtlas(grid, 2048);
        const exact = countCodes(grid, atlas);
        const shown = countCodes({ ...grid, codes: new Uint8Array(0) }, atlas);
        const sum = (counts: Uint32Array) => counts.reduce((a, b) => a + b, 0);
        assert.equal(sum(shown), sum(exact));
        const middle = (counts: Uint32Array) =>
            counts.reduce((all, count, code) => all + count * code, 0) / sum(counts);
        assert(
            Math.abs(middle(shown) - middle(exact)) <= (codeBytes === 1 ? 0 : 0.5 * atlas.codeScale),
            `${middle(shown)} ${middle(exact)}`,
        );
    }
});
