import assert from 'node:assert/strict';
import test from 'node:test';

import { countCodes, histogramOf } from '../src/tables/histogram';
import { codeAt, firstValueCode, readPackedGrid, valueOf } from '../src/wire/packed_grid';
import { makeGrid } from './made_grid';

test('each value of the grid is counted once, in its column', () => {
    const grid = readPackedGrid(makeGrid(20, 18, 17).bytes);
    const slow = new Map<number, number>();
    for (let x = 0; x < grid.nx; ++x) {
        for (let y = 0; y < grid.ny; ++y) {
            for (let z = 0; z < grid.nz; ++z) {
                const code = codeAt(grid, x, y, z);
                if (code >= firstValueCode) slow.set(code, (slow.get(code) ?? 0) + 1);
            }
        }
    }
    const counts = countCodes(grid);
    assert(slow.size > 1);
    for (const [code, count] of slow) assert.equal(counts[code], count);
    const all = [...slow.values()].reduce((a, b) => a + b, 0);
    assert.equal(counts.reduce((a, b) => a + b, 0), all, 'states are not counted');
    const low = valueOf(grid, Math.min(...slow.keys()));
    const histogram = histogramOf(grid, low + 1e-9, low + 2, 8);
    assert.equal(histogram.reduce((a, b) => a + b, 0), all, 'what lies beyond is in the outermost columns');
    assert(histogram[0]! >= slow.get(Math.min(...slow.keys()))!);
});
