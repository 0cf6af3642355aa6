import assert from 'node:assert/strict';
import test from 'node:test';

import { PackedError, codeAt, readPackedGrid, readPlace, valueOf } from './packed_grid';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';

// A grid with bricks of each kind (values, mixed states, one state), and with incomplete bricks at its edges.
const mixed: Made = {
    nx: 49,
    ny: 21,
    levelsM: evenLevels(18),
    codeOf(x, y, z) {
        if (x < 16) return scrambled(x, y, z) % 256;
        if (x < 32) return y < 16 ? scrambled(x, y, z) % 3 : 1;
        return 2;
    },
};

test('every cell is read right, in bricks of each kind', () => {
    for (const codeBytes of [1, 2] as const) {
        const grid = readPackedGrid(packedGrid({ ...mixed, codeBytes }));
        assert.deepEqual([...new Set(grid.kind)].sort(), [0, 1, 2]);
        for (let x = 0; x < 49; ++x)
            for (let y = 0; y < 21; ++y)
                for (let z = 0; z < 18; ++z)
                    assert.equal(codeAt(grid, x, y, z), mixed.codeOf(x, y, z), `${x} ${y} ${z}`);
    }
});

test('codes of two bytes may be above 255', () => {
    const grid = readPackedGrid(packedGrid({ ...mixed, codeBytes: 2, codeOf: (x) => 300 + x }));
    assert.equal(codeAt(grid, 48, 3, 3), 348);
});

test('the header has moment, time and place of the grid', () => {
    const grid = readPackedGrid(packedGrid(mixed));
    assert.equal(grid.id, 'abc0123456789def');
    assert.deepEqual([grid.nx, grid.ny, grid.nz], [49, 21, 18]);
    assert.deepEqual([grid.timeMs, grid.startMs, grid.endMs], [1000, 500, 1500]);
    assert.deepEqual(grid.sites, [{ latitudeDeg: 35.3331, longitudeDeg: -97.2777, altitudeM: 389, icao: 'KTLX' }]);
    assert.equal(valueOf(grid, 3), -32);
    assert.equal(valueOf(grid, 83), 8);
    assert.deepEqual([...grid.levelsM], evenLevels(18));
});

test('the place of a grid is read from its header alone', () => {
    const bytes = packedGrid({ ...mixed, spacing: 500 });
    const place = readPlace(bytes);
    assert.deepEqual(place, {
        projection: 0,
        nx: 49,
        ny: 21,
        centerDeg: [35.3331, -97.2777],
        spacing: 500,
        parallelsDeg: [0, 0],
        offsetCells: [0, 0],
    });
    const grid: Record<string, unknown> = { ...readPackedGrid(bytes) };
    for (const [name, value] of Object.entries(place)) assert.deepEqual(grid[name], value, name);
});

test('bytes that are cut anywhere, or are no packed grid, are refused', () => {
    const whole = packedGrid(mixed);
    for (const size of [0, 8, 255, 256, 300, 800, whole.length - 1])
        assert.throws(() => readPackedGrid(whole.slice(0, size)), PackedError, String(size));
    const other = whole.slice();
    other[1] = 0x54;
    assert.throws(() => readPackedGrid(other), PackedError);
});

test('a header or a table that contradicts the rest is refused', () => {
    const tableAt = Number(new DataView(packedGrid(mixed).buffer).getBigUint64(224, true));
    for (const [at, value, error] of [
        [tableAt + 8, 1e6, PackedError], // the block of the first brick does not exist
        [tableAt, 3, /unknown kind/], // kind of the first brick
        [196, 0, PackedError], // number of blocks of codes
        [204, 7, PackedError], // number of rows
    ] as const) {
        const bytes = packedGrid(mixed);
        new DataView(bytes.buffer).setUint32(at, value, true);
        assert.throws(() => readPackedGrid(bytes), error, `${value} at ${at}`);
    }
});
