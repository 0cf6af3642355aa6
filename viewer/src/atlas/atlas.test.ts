import assert from 'node:assert/strict';
import test from 'node:test';

import { Atlas, coverageOf, makeAtlas, paddedEdge, putReaches, slotOf } from './atlas';
import { PackedGrid, codeAt, readPackedGrid } from '../wire/packed_grid';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';

const made: Made = {
    nx: 50,
    ny: 33,
    levelsM: evenLevels(20),
    // Echo in one corner, so that most bricks are empty.
    codeOf: (x, y, z) => (x < 18 && y < 20 ? scrambled(x, y, z) % 256 : x < 40 ? 1 : 0),
};
const mostTexels = 2048;

function texel(atlas: Atlas, x: number, y: number, z: number): [number, number] {
    const at = 2 * ((z * atlas.size[1] + y) * atlas.size[0] + x);
    return [atlas.texels[at]!, atlas.texels[at + 1]!];
}

// Interpolates R and G of eight texels at a place in cells, as the texture unit does.
function fetched(
    grid: PackedGrid,
    atlas: Atlas,
    place: [number, number, number],
): { share: number; mean: number } | null {
    const brick = place.map((p) => Math.floor(p / 16)) as [number, number, number];
    const entry = atlas.indirection[(brick[2] * atlas.bricks[1] + brick[1]) * atlas.bricks[0] + brick[0]]!;
    const slot = slotOf(entry);
    if (slot < 0) return null;
    const corner = [
        slot % atlas.slots[0],
        Math.floor(slot / atlas.slots[0]) % atlas.slots[1],
        Math.floor(slot / (atlas.slots[0] * atlas.slots[1])),
    ];
    const at = place.map((p, i) => corner[i]! * paddedEdge + (p - 16 * brick[i]!) + 1);
    const base = at.map(Math.floor);
    let [sum, share] = [0, 0];
    for (let i = 0; i < 8; ++i) {
        const side = [i & 1, (i >> 1) & 1, i >> 2];
        const weight = side.reduce(
            (w, s, axis) => w * (s ? at[axis]! - base[axis]! : 1 - (at[axis]! - base[axis]!)),
            1,
        );
        const [r, g] = texel(atlas, base[0]! + side[0]!, base[1]! + side[1]!, base[2]! + side[2]!);
        sum += weight * r;
        share += (weight * g) / 255;
    }
    assert.equal(grid.brickEdge, 16);
    return { share, mean: share > 0 ? sum / share : NaN };
}

// Computes the wanted share and mean from eight cells of the grid, without the atlas.
function wanted(grid: PackedGrid, place: [number, number, number]): { share: number; mean: number } {
    let [sum, share] = [0, 0];
    const base = place.map(Math.floor);
    for (let i = 0; i < 8; ++i) {
        const side = [i & 1, (i >> 1) & 1, i >> 2];
        const cell = base.map((b, axis) => Math.min([grid.nx, grid.ny, grid.nz][axis]! - 1, b + side[axis]!)) as [
            number,
            number,
            number,
        ];
        const weight = side.reduce(
            (w, s, axis) => w * (s ? place[axis]! - base[axis]! : 1 - (place[axis]! - base[axis]!)),
            1,
        );
        const code = codeAt(grid, ...cell);
        if (code < 3) continue;
        sum += weight * code;
        share += weight;
    }
    return { share, mean: share > 0 ? sum / share : NaN };
}

test('the atlas and the cells give the same sample, across bricks too, and no state becomes a value', () => {
    const grid = readPackedGrid(packedGrid(made));
    const atlas = makeAtlas(grid, mostTexels);
    let samples = 0;
    for (let i = 0; i < 20000; ++i) {
        const part = (k: number, most: number) => (scrambled(i, k, 7) / 2 ** 32) * (most - 1);
        const place: [number, number, number] = [part(1, 50), part(2, 33), part(3, 20)];
        const want = wanted(grid, place);
        const found = fetched(grid, atlas, place);
        if (!found) {
            assert.equal(want.share, 0, `an empty brick hides a value at ${place.join(' ')}`);
            continue;
        }
        assert(Math.abs(found.share - want.share) < 1e-9, `share at ${place.join(' ')}`);
        if (want.share > 0) assert(Math.abs(found.mean - want.mean) < 1e-6, `mean at ${place.join(' ')}`);
        ++samples;
    }
    assert(samples > 2000);
});

test('a brick that shows no value takes no room', () => {
    const grid = readPackedGrid(packedGrid(made));
    const atlas = makeAtlas(grid, mostTexels);
    assert(atlas.brickCount < grid.kind.length / 2);
    assert(atlas.texels.length >= 2 * atlas.brickCount * paddedEdge ** 3);
});

test('a grid without values has an atlas without bricks', () => {
    const grid = readPackedGrid(packedGrid({ ...made, codeOf: () => 1 }));
    const atlas = makeAtlas(grid, mostTexels);
    assert.equal(atlas.brickCount, 0);
    assert(atlas.indirection.every((entry) => slotOf(entry) < 0));
});

test('the highest byte of an entry is the greatest code that a sample in the brick can find', () => {
    const grid = readPackedGrid(
        packedGrid({
            ...made,
            codeOf: (x, y, z) => (x === 16 && y === 0 && z === 0 ? 200 : x === 5 && y === 0 && z === 0 ? 90 : 1),
        }),
    );
    const atlas = makeAtlas(grid, mostTexels);
    assert.equal(atlas.indirection[0]! >>> 24, 200, 'the neighbor to the east lends its first cells');
});

test('each block of a slot knows the greatest code of the cells that its samples use', () => {
    const grid = readPackedGrid(packedGrid(made));
    const atlas = makeAtlas(grid, mostTexels);
    const [bx, by] = atlas.bricks;
    atlas.indirection.forEach((entry, i) => {
        const slot = slotOf(entry);
        if (slot < 0) return;
        const brick = [i % bx, Math.floor(i / bx) % by, Math.floor(i / (bx * by))] as const;
        for (let block = 0; block < 64; ++block) {
            const first = [block % 4, (block >> 2) % 4, block >> 4].map((n, axis) => 16 * brick[axis]! + 4 * n) as [
                number,
                number,
                number,
            ];
            let greatest = 0;
            for (let cell = 0; cell < 125; ++cell) {
                const at = [cell % 5, Math.floor(cell / 5) % 5, Math.floor(cell / 25)].map((d, axis) =>
                    Math.min([50, 33, 20][axis]! - 1, first[axis]! + d),
                );
                const code = codeAt(grid, at[0]!, at[1]!, at[2]!);
                if (code >= 3) greatest = Math.max(greatest, code);
            }
            assert.equal(atlas.blocks[64 * slot + block], greatest, `brick ${brick.join(' ')} block ${block}`);
        }
    });
});

test('codes of two bytes are shown within half a step of eight bits', () => {
    const grid = readPackedGrid(
        packedGrid({ ...made, codeBytes: 2, codeOf: (x, y, z) => 1000 + (scrambled(x, y, z) % 3000) }),
    );
    const atlas = makeAtlas(grid, mostTexels);
    for (const [x, y, z] of [
        [0, 0, 0],
        [7, 9, 11],
        [15, 15, 15],
    ] as const) {
        const found = fetched(grid, atlas, [x, y, z])!;
        assert(
            Math.abs(atlas.codeOffset + atlas.codeScale * found.mean - codeAt(grid, x, y, z)) <=
                atlas.codeScale / 2 + 1e-9,
        );
    }
});

test('the histogram counts every value once', () => {
    const grid = readPackedGrid(packedGrid(made));
    let values = 0;
    for (let x = 0; x < 50; ++x)
        for (let y = 0; y < 33; ++y) for (let z = 0; z < 20; ++z) values += made.codeOf(x, y, z) >= 3 ? 1 : 0;
    assert.equal(
        makeAtlas(grid, mostTexels).histogram.reduce((sum, n) => sum + n, 0),
        values,
    );
});

test('an atlas that a device cannot hold is refused', () => {
    const grid = readPackedGrid(packedGrid({ ...made, codeOf: () => 9 }));
    assert.throws(() => makeAtlas(grid, 20), RangeError);
});

test('the ground knows which columns were seen, and from how low', () => {
    const grid = readPackedGrid(
        packedGrid({
            ...made,
            codeOf: (x, _y, z) => (x < 10 ? 1 : x < 20 ? (z > 10 ? 1 : 0) : x < 30 ? (z > 10 ? 50 : 0) : 0),
        }),
    );
    const coverage = coverageOf(grid);
    assert.deepEqual(
        [0, 10, 20, 30, 49].map((x) => coverage[5 * 50 + x]),
        [2, 1, 1, 0, 0],
    );
});

test('columns without bricks know how far the next column with a brick is', () => {
    const size = [20, 15, 3] as const;
    const indirection = new Uint32Array(20 * 15 * 3);
    const places = [
        [3, 4, 1],
        [17, 12, 0],
        [4, 4, 2],
    ] as const;
    for (const [x, y, z] of places) indirection[(z * 15 + y) * 20 + x] = 5;
    putReaches(indirection, size);
    for (let x = 0; x < 20; ++x)
        for (let y = 0; y < 15; ++y)
            for (let z = 0; z < 3; ++z) {
                const entry = indirection[(z * 15 + y) * 20 + x]!;
                const away = Math.min(...places.map(([px, py]) => Math.max(Math.abs(px - x), Math.abs(py - y))));
                const has = places.some((place) => place.join() === [x, y, z].join());
                assert.equal(entry, has ? 5 : Math.min(7, away) << 21, `${x} ${y} ${z}`);
            }
});
