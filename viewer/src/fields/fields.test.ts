import assert from 'node:assert/strict';
import test from 'node:test';

import { airOf } from './air';
import { fallOf, fallsOf } from './falls';
import { levelsAbout, maximumField, planeField } from './flat_field';
import { cutSection, greatestOf } from './section';
import { Mixer } from './status_rule';
import { planeOf } from '../earth/projection';
import { CellState, codeAt, readPackedGrid, valueOf } from '../wire/packed_grid';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';

const made: Made = {
    nx: 50,
    ny: 33,
    levelsM: evenLevels(20),
    codeOf: (x, y, z) => (x < 18 && y < 20 ? scrambled(x, y, z) % 256 : x < 40 ? 1 : 0),
};
const grid = readPackedGrid(packedGrid(made));

function mixed(mixer: Mixer, ...parts: [CellState, number, number][]): [CellState, number] {
    mixer.clear();
    for (const part of parts) mixer.add(...part);
    mixer.result();
    return [mixer.state, mixer.value];
}

test('the weights of cells decide the state, and a mean counts values only', () => {
    const mixer = new Mixer('mean');
    assert.deepEqual(mixed(mixer, [3, 40, 0.5], [1, 0, 0.5]), [CellState.value, 40]);
    assert.deepEqual(mixed(mixer, [3, 40, 0.4], [1, 0, 0.6]), [CellState.noEcho, 0]);
    assert.deepEqual(mixed(mixer, [3, 40, 0.4], [0, 0, 0.6]), [CellState.notSeen, 0]);
    assert.deepEqual(mixed(mixer, [3, 40, 0.25], [3, 60, 0.25], [0, 0, 0.5]), [CellState.value, 50]);
    assert.deepEqual(mixed(mixer, [3, 40, 0.2], [2, 0, 0.5], [1, 0, 0.3]), [CellState.rangeFolded, 0]);
    assert.deepEqual(mixed(mixer), [CellState.notSeen, 0]);
});

test('velocities take the heaviest cell, and phases average on a circle', () => {
    assert.deepEqual(mixed(new Mixer('heaviest'), [3, -30, 0.4], [3, 28, 0.6]), [CellState.value, 28]);
    assert.deepEqual(mixed(new Mixer('circle'), [3, 350, 0.5], [3, 20, 0.5]), [CellState.value, 5]);
});

test('a plane at a level equals that level, and a plane between two levels mixes them', () => {
    const atLevel = planeField(grid, 'REF', grid.levelsM[7]!)!;
    const between = planeField(grid, 'REF', grid.levelsM[7]! + 100)!;
    let values = 0;
    for (let y = 0; y < grid.ny; ++y) {
        for (let x = 0; x < grid.nx; ++x) {
            const [lower, upper] = [codeAt(grid, x, y, 7), codeAt(grid, x, y, 8)];
            const at = y * grid.nx + x;
            assert.equal(atLevel.states[at], Math.min(3, lower));
            if (lower >= 3) assert.equal(atLevel.values[at], valueOf(grid, lower));
            if (lower < 3 || upper < 3) continue;
            ++values;
            assert(Math.abs(between.values[at]! - (0.8 * valueOf(grid, lower) + 0.2 * valueOf(grid, upper))) < 1e-5);
        }
    }
    assert(values > 200);
    assert.equal(planeField(grid, 'REF', 50000), null);
    assert.deepEqual(levelsAbout([500, 1000], 300), { lower: 0, upper: 0, upperShare: 0 });
});

test('the maximum of a column is its greatest cell', () => {
    const field = maximumField(grid);
    for (let y = 0; y < grid.ny; ++y) {
        for (let x = 0; x < grid.nx; ++x) {
            const most = Math.max(...Array.from({ length: grid.nz }, (_, z) => codeAt(grid, x, y, z)));
            assert.equal(field.states[y * grid.nx + x], Math.min(3, most));
            if (most >= 3) assert.equal(field.values[y * grid.nx + x], valueOf(grid, most));
        }
    }
});

test('a section goes through the cells on its way', () => {
    // Values rise to the east, by one code a cell, and with the level; nothing is seen below 1 km.
    const slope = readPackedGrid(
        packedGrid({ nx: 41, ny: 41, levelsM: evenLevels(10), codeOf: (x, _, z) => (z === 0 ? 0 : 3 + x + 10 * z) }),
    );
    const plane = planeOf(slope);
    const section = cutSection(slope, 'REF', plane.toPlace([-10000, 500]), plane.toPlace([10000, 500]), 200, 110);
    assert(Math.abs(section.lengthM - 20000) < 1);
    assert(section.inGrid.every((one) => one === 1));
    for (const column of [0, 57, 199]) {
        const cell = 20 + ((column + 0.5) / 200) * 20 - 10;
        const row = 60; // 2.887 km high
        const level = (((row + 0.5) / 110) * section.topM - 500) / 500;
        const at = row * 200 + column;
        assert.equal(section.field.states[at], CellState.value);
        assert(
            Math.abs(section.field.values[at]! - valueOf(slope, 3 + cell + 10 * level)) < 0.01,
            `${section.field.values[at]}`,
        );
        assert.equal(section.field.states[column], CellState.notSeen);
    }
    const greatest = greatestOf(section)!;
    assert(greatest.distanceM > 19900 && greatest.heightM > 4900);
    const beyond = cutSection(slope, 'REF', plane.toPlace([0, 0]), plane.toPlace([40000, 0]), 100, 10);
    assert.deepEqual([beyond.inGrid[50], beyond.inGrid[60]], [1, 0]);
});

test('coarse cells have the shares of unseen and of range folded air', () => {
    const own = readPackedGrid(
        packedGrid({
            nx: 20,
            ny: 17,
            levelsM: evenLevels(5),
            codeOf: (x, _, z) => (z >= 4 ? 0 : x < 4 ? 2 : x === 4 ? 0 : 1),
        }),
    );
    const air = airOf(own);
    assert.deepEqual(air.size, [5, 5, 3]);
    const at = (x: number, y: number, z: number) => [
        ...air.shares.subarray(2 * ((z * 5 + y) * 5 + x), 2 * ((z * 5 + y) * 5 + x) + 2),
    ];
    assert.deepEqual(at(0, 0, 0), [0, 255]);
    assert.deepEqual(at(1, 4, 1), [64, 0]);
    assert.deepEqual(at(3, 2, 2), [255, 0]);
});

test('values fall away from their greatest, and unseen air makes no fall', () => {
    // A ball of echo about column (32, 32), level 8; its lower half was not seen.
    const ball = (x: number, y: number, z: number) => Math.max(0, 60 - 3 * Math.hypot(x - 32, y - 32, 2 * (z - 8)));
    const own = readPackedGrid(
        packedGrid({
            nx: 64,
            ny: 64,
            levelsM: evenLevels(16),
            firstValue: 0,
            step: 0.5,
            codeOf: (x, y, z) => (z < 4 ? 0 : 3 + Math.round(2 * ball(x, y, z))),
        }),
    );
    const { size, bytes } = fallsOf(own, 'REF', 5);
    assert.deepEqual(size, [32, 32, 16]);
    const at = (x: number, y: number, z: number) => [
        ...bytes.subarray(4 * ((x * 32 + y) * 16 + z), 4 * ((x * 32 + y) * 16 + z) + 4),
    ];
    const east = at(20, 16, 8);
    assert(fallOf(east[0]!) > 5 && Math.abs(fallOf(east[1]!)) < 1, String(east));
    assert(fallOf(at(16, 12, 8)[1]!) < -5);
    assert(fallOf(at(16, 16, 11)[2]!) > 2);
    assert.equal(fallOf(at(16, 16, 1)[2]!), 0);
    assert.equal(at(0, 0, 8)[3], 0);
});
