import assert from 'node:assert/strict';
import test from 'node:test';
import { Atlas, coverageOf, makeAtlas, paddedEdge, slotOf } from './atlas';
import { codeAt, readPackedGrid } from '../wire/packed_grid';
import { makeGrid } from '../testing/made_grid';

function texel(atlas: Atlas, slot: number, x: number, y: number, z: number): [number, number] {
    const at = [
        (slot % atlas.slots[0]) * paddedEdge + x,
        (Math.floor(slot / atlas.slots[0]) % atlas.slots[1]) * paddedEdge + y,
        Math.floor(slot / (atlas.slots[0] * atlas.slots[1])) * paddedEdge + z,
    ] as const;
    const i = 2 * ((at[2] * atlas.size[1] + at[1]) * atlas.size[0] + at[0]);
    return [atlas.texels[i]!, atlas.texels[i + 1]!];
}

test('each sample finds the eight cells about it in one brick of the atlas', () => {
    const made = makeGrid(40, 35, 20);
    const grid = readPackedGrid(made.bytes);
    const atlas = makeAtlas(grid, 2048);
    let checked = 0;
    for (let x = 0; x < made.nx - 1; ++x)
        for (let y = 0; y < made.ny - 1; ++y)
            for (let z = 0; z < made.nz - 1; ++z) {
                const brick = [x, y, z].map((n) => Math.floor(n / 16)) as [number, number, number];
                const entry = atlas.indirection[(brick[2] * atlas.bricks[1] + brick[1]) * atlas.bricks[0] + brick[0]]!;
                for (const [dx, dy, dz] of [
                    [0, 0, 0],
                    [1, 0, 0],
                    [0, 1, 0],
                    [1, 1, 1],
                ] as const) {
                    const code = made.code(x + dx, y + dy, z + dz);
                    if (slotOf(entry) < 0) {
                        assert(code < 3, 'a brick without a slot shows nothing');
                        continue;
                    }
                    const found = texel(atlas, slotOf(entry), (x % 16) + dx + 1, (y % 16) + dy + 1, (z % 16) + dz + 1);
                    const expected = code < 3 ? [0, 0] : [code, 255];
                    if (found[0] !== expected[0] || found[1] !== expected[1])
                        assert.deepEqual(found, expected, `${x} ${y} ${z}`);
                    if (code >= 3) assert(entry >>> 24 >= code, 'the greatest code of a brick is known');
                    ++checked;
                }
            }
    assert(checked > 10_000);
});

test('codes of two bytes are shown within half a step of eight bits', () => {
    const made = makeGrid(20, 20, 16, 2, 250);
    const grid = readPackedGrid(made.bytes);
    const atlas = makeAtlas(grid, 2048);
    assert(atlas.codeScale > 1);
    for (let x = 0; x < 16; ++x) {
        const code = codeAt(grid, x, 3, 5);
        if (code < 3) continue;
        const entry = atlas.indirection[0]!;
        const [shown, valued] = texel(atlas, slotOf(entry), x + 1, 4, 6);
        assert.equal(valued, 255);
        assert(Math.abs(atlas.codeOffset + atlas.codeScale * shown - code) <= 0.5 * atlas.codeScale + 1e-6);
    }
});

test('a grid that needs more than a texture holds is refused', () => {
    assert.throws(() => makeAtlas(readPackedGrid(makeGrid(64, 64, 32).bytes), 36), RangeError);
});

test('coverage tells what was seen of each column', () => {
    const made = makeGrid(40, 35, 20);
    const grid = readPackedGrid(made.bytes);
    const coverage = coverageOf(grid);
    for (let x = 0; x < made.nx; ++x)
        for (let y = 0; y < made.ny; ++y) {
            let lowest = -1;
            for (let z = made.nz - 1; z >= 0; --z) if (made.code(x, y, z) !== 0) lowest = z;
            const expected = lowest < 0 ? 0 : 500 * (lowest + 1) < 3000 ? 2 : 1;
            if (coverage[y * made.nx + x] !== expected) assert.equal(coverage[y * made.nx + x], expected, `${x} ${y}`);
        }
});
