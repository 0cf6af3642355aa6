import assert from 'node:assert/strict';
import test from 'node:test';
import { PackedError, codeAt, readPackedGrid, valueOf } from './packed_grid';
import { makeGrid } from '../testing/made_grid';

test('every cell of a packed grid is the one that was packed', () => {
    for (const codeBytes of [1, 2] as const) {
        const made = makeGrid(37, 100, 20, codeBytes, codeBytes === 2 ? 13 : 1);
        const grid = readPackedGrid(made.bytes);
        let values = 0;
        for (let x = 0; x < made.nx; ++x)
            for (let y = 0; y < made.ny; ++y)
                for (let z = 0; z < made.nz; ++z) {
                    const code = codeAt(grid, x, y, z);
                    if (code !== made.code(x, y, z)) assert.equal(code, made.code(x, y, z), `${x} ${y} ${z}`);
                    if (code >= 3) ++values;
                }
        assert(values > 1000);
        assert(
            [...grid.kind].includes(0) && [...grid.kind].includes(1) && [...grid.kind].includes(2),
            'all kinds of bricks',
        );
    }
});

test('the header says where and when', () => {
    const grid = readPackedGrid(makeGrid(16, 32, 4).bytes);
    assert.equal(grid.id, '0123456789abcdef');
    assert.deepEqual(grid.centerDeg, [35.3, -97.3]);
    assert.equal(grid.timeMs, 1_000_000);
    assert.deepEqual([...grid.levelsM], [500, 1000, 1500, 2000]);
    assert.deepEqual(grid.sites, [{ latitudeDeg: 35.3, longitudeDeg: -97.3, altitudeM: 400, icao: 'KTLX' }]);
    assert.equal(valueOf(grid, 3), -32);
    assert.equal(valueOf(grid, 103), 18);
});

test('what is cut or is no packed grid is refused', () => {
    const { bytes } = makeGrid(20, 20, 20);
    for (const length of [0, 7, 255, 300, bytes.length - 1])
        assert.throws(() => readPackedGrid(bytes.slice(0, length)), PackedError);
    const other = bytes.slice();
    other[1] = 0x54;
    assert.throws(() => readPackedGrid(other), PackedError);
    const beyond = bytes.slice();
    new DataView(beyond.buffer).setUint32(196, 0, true); // its blocks of codes are not there
    assert.throws(() => readPackedGrid(beyond), PackedError);
});
