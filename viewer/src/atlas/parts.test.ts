// Tests grids in parts: how they are read, and which texels are made of the columns of bricks that have come.

import assert from 'node:assert/strict';
import test from 'node:test';

import { makeAtlas, paddedEdge, placeOfSlot, rangeOfCodes, shownCodes, slotOf } from './atlas';
import { BrickStore, brickTexelBytes } from './brick_store';
import { paintPages } from './page_table';
import { Pyramid, bricksShown, levelWithin, pyramidOf } from './pyramid';
import { SlotPool, columnKey } from './slot_pool';
import {
    BrickKind,
    PackedBricks,
    PackedGrid,
    codeAt,
    readGridOrTable,
    readPackedBricks,
    readPackedGrid,
    withBricks,
} from '../wire/packed_grid';
import { rangesOf } from '../wire/ranges';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';

const made: Made = {
    nx: 75,
    ny: 53,
    levelsM: evenLevels(33),
    codeOf: (x, y, z) => (scrambled(x >> 4, y >> 4, z >> 4) % 3 === 0 && z < 20 ? scrambled(x, y, z) % 256 : 1),
};
const whole = readPackedGrid(packedGrid(made));
const [, columnsY, layers] = whole.bricks;
const tableOf = (grid: PackedGrid): PackedGrid => ({ ...grid, codes: new Uint8Array(0), states: new Uint8Array(0) });

// Returns the bricks of the columns [first, end), as the server sends them.
function bricksOf(grid: PackedGrid, first: number, end: number): PackedBricks {
    const stored = (until: number) => grid.kind.subarray(0, until).filter((kind) => kind === BrickKind.codes).length;
    const [from, to] = [stored(first * layers), stored(end * layers)];
    return {
        id: grid.id,
        halvings: grid.halvings,
        first: first * layers,
        end: end * layers,
        firstBlock: from,
        codes: grid.codes.slice(from * 4096, to * 4096),
        firstStates: 0,
        states: grid.states,
    };
}
function storeOf(grid: PackedGrid): BrickStore {
    const store = new BrickStore(shownCodes(grid, ...rangeOfCodes(grid)));
    store.addLevel(tableOf(grid));
    return store;
}

test('the table of a grid is read without its cells', () => {
    const bytes = packedGrid(made);
    const view = new DataView(bytes.buffer);
    const statesAt = Number(view.getBigUint64(232, true));
    const table = bytes.slice(0, statesAt);
    const header = new DataView(table.buffer);
    header.setUint32(160, 1, true);
    header.setBigUint64(16, BigInt(table.length), true);
    for (const at of [188, 196, 232, 240]) header.setUint32(at, 0, true);
    const { grid, isWhole } = readGridOrTable(table);
    assert(!isWhole);
    assert.deepEqual([...grid.greatestCode], [...whole.greatestCode]);
    assert.equal(grid.codes.length, 0);
    assert.throws(() => readPackedGrid(table), /part/);
    assert.throws(() => readPackedBricks(table), /no bricks/);
});

// Returns the packed form that has codes for cells with values only, and states for all cells.
function valuesAlone(bytes: Uint8Array): Uint8Array {
    const grid = readPackedGrid(bytes);
    const view = new DataView(bytes.buffer);
    const states: number[] = [];
    const values: number[] = [];
    grid.kind.forEach((kind, i) => {
        if (kind === BrickKind.states)
            states.push(...grid.states.subarray(grid.block[i]! * 1024, (grid.block[i]! + 1) * 1024));
        if (kind !== BrickKind.codes) return;
        const codes = [...grid.codes.subarray(grid.block[i]! * 4096, (grid.block[i]! + 1) * 4096)];
        for (let c = 0; c < 4096; c += 4)
            states.push([0, 1, 2, 3].reduce((bits, n) => bits | (Math.min(3, codes[c + n]!) << (2 * n)), 0));
        values.push(...codes.filter((code) => code >= 3));
    });
    const statesAt = Number(view.getBigUint64(232, true));
    const made = new Uint8Array(statesAt + states.length + values.length * grid.codeBytes);
    made.set(bytes.subarray(0, statesAt));
    made.set(states, statesAt);
    made.set(
        new Uint8Array(
            (grid.codeBytes === 1 ? Uint8Array : Uint16Array).from(values.map((code, i) => code - (values[i - 1] ?? 0)))
                .buffer,
        ),
        statesAt + states.length,
    );
    const header = new DataView(made.buffer);
    header.setBigUint64(16, BigInt(made.length), true);
    header.setUint32(172, 4, true);
    header.setUint32(188, states.length / 1024, true);
    header.setUint32(196, values.length, true);
    header.setBigUint64(240, BigInt(statesAt + states.length), true);
    return made;
}

test('codes of values alone are spread to their cells', () => {
    for (const codeBytes of [1, 2] as const) {
        const bytes = packedGrid({ ...made, codeBytes });
        const [plain, spread] = [readPackedGrid(bytes), readPackedGrid(valuesAlone(bytes))];
        assert.deepEqual([...spread.codes], [...plain.codes]);
        assert.deepEqual([...spread.states], [...plain.states]);
        const cut = valuesAlone(bytes);
        new DataView(cut.buffer).setUint32(196, new DataView(cut.buffer).getUint32(196, true) - 1, true);
        assert.throws(() => readPackedGrid(cut), /as many codes/);
    }
});

test('a range of bricks is read', () => {
    const bytes = packedGrid(made);
    const header = new DataView(bytes.buffer);
    header.setUint32(160, 2, true);
    header.setUint32(176, 3, true);
    header.setUint32(180, 9, true);
    header.setUint32(192, 2, true);
    const bricks = readPackedBricks(bytes);
    assert.deepEqual([bricks.first, bricks.end, bricks.firstBlock], [3, 9, 2]);
    assert.equal(bricks.codes.length, whole.codes.length);
    assert.throws(() => readPackedBricks(bytes.slice(0, bytes.length - 1)), /cut/);
});

test('a range of bricks has the same cells as the whole grid', () => {
    const states = (until: number) => whole.kind.subarray(0, until).filter((kind) => kind === BrickKind.states).length;
    for (const column of [0, 7, 13]) {
        const firstStates = states(column * layers);
        const bricks = {
            ...bricksOf(whole, column, column + 1),
            firstStates,
            states: whole.states.slice(firstStates * 1024),
        };
        const grid = withBricks(tableOf(whole), bricks);
        const [x, y] = [16 * Math.floor(column / columnsY), 16 * (column % columnsY)];
        for (let i = 0; i < 16 * 33; ++i) {
            const place = [x + (i % 16 < whole.nx - x ? i % 16 : 0), y, Math.floor(i / 16)] as const;
            assert.equal(codeAt(grid, ...place), codeAt(whole, ...place));
        }
    }
});

test('columns that come one at a time make the texels of the whole grid', () => {
    const atlas = makeAtlas(whole, 2048);
    const store = storeOf(whole);
    for (let column = whole.bricks[0] * columnsY - 1; column >= 0; --column)
        store.addBricks(bricksOf(whole, column, column + 1));
    let compared = 0;
    for (let x = 0; x < whole.bricks[0]; ++x) {
        for (let y = 0; y < columnsY; ++y) {
            const { hasValues, texels } = store.make(0, x, y);
            let from = 0;
            for (let z = 0; z < layers; ++z) {
                const entry = atlas.indirection[(z * columnsY + y) * whole.bricks[0] + x]!;
                if (!hasValues[z]) continue;
                const one = texels.subarray(from, (from += brickTexelBytes));
                if (slotOf(entry) < 0) continue; // only its lower neighbors have values, and no sample uses these
                const [px, py, pz] = placeOfSlot(slotOf(entry), atlas.slots);
                for (let row = 0; row < paddedEdge ** 2; ++row) {
                    const at =
                        2 *
                        (((pz + Math.floor(row / paddedEdge)) * atlas.size[1] + py + (row % paddedEdge)) *
                            atlas.size[0] +
                            px);
                    const here = one.subarray(2 * row * paddedEdge, 2 * (row + 1) * paddedEdge);
                    if (!here.every((texel, i) => texel === atlas.texels[at + i]))
                        assert.ok(false, `${x} ${y} ${z}, row ${row}`);
                }
                ++compared;
            }
        }
    }
    assert(compared > 10);
});

test('a neighbor that has not come, or was dropped, counts as having no values', () => {
    const store = storeOf(whole);
    const valued = [...whole.kind.keys()].find((i) => whole.kind[i] === BrickKind.codes)!;
    const column = Math.floor(valued / layers);
    const place = [Math.floor(column / columnsY), column % columnsY] as const;
    assert.equal(store.make(0, ...place).texels.length, 0);
    store.addBricks(bricksOf(whole, column, column + 1));
    assert(store.make(0, ...place).texels.length > 0);
    store.drop(0, ...place);
    assert.equal(store.make(0, ...place).texels.length, 0);
});

test('the pyramid bounds every cell of every halved grid', () => {
    const pyramid = pyramidOf(tableOf(whole));
    for (let x = 0; x < made.nx; ++x)
        for (let y = 0; y < made.ny; ++y)
            for (let z = 0; z < 33; ++z) {
                const code = codeAt(whole, x, y, z);
                if (code < 3) continue;
                pyramid.levels.forEach(({ columns, greatest, about }, level) => {
                    const at = ((x >> (4 + level)) * columns[1] + (y >> (4 + level))) * pyramid.layers + (z >> 4);
                    assert(greatest[at]! >= code && about[at]! >= greatest[at]!);
                });
            }
    assert.equal(levelWithin(pyramid, 1e9), 0);
    assert.equal(levelWithin(pyramid, bricksShown(pyramid.levels[1]!)), 1);
    assert.equal(levelWithin(pyramid, 0), 6);
});

test('a brick of the grid shows the finest column that has come', () => {
    const pyramid: Pyramid = pyramidOf(tableOf(whole));
    const entries = new Uint32Array(whole.kind.length);
    const shownOf = Uint8Array.from({ length: 65536 }, (_, code) => Math.min(code, 255));
    const slots = (first: number) => Int32Array.from({ length: layers }, (_, z) => first + z);
    paintPages(
        entries,
        pyramid,
        [
            { level: 0, x: 0, y: 0, slots: slots(100) },
            { level: 1, x: 0, y: 0, slots: slots(7) },
        ],
        shownOf,
    );
    const entryAt = (x: number, y: number, z: number) => entries[(z * columnsY + y) * whole.bricks[0] + x]!;
    for (const [x, y, slot, level] of [
        [0, 0, 100, 0],
        [1, 0, 7, 1],
        [0, 1, 7, 1],
        [1, 1, 7, 1],
    ] as const) {
        const entry = entryAt(x, y, 0);
        if (pyramid.levels[0]!.about[(x * columnsY + y) * layers] === 0) continue;
        assert.deepEqual([slotOf(entry), (entry >> 21) & 7], [slot, level], `${x} ${y}`);
    }
    assert.equal(slotOf(entryAt(2, 0, 0)), -1, 'no brick of this column has come');
});

test('wanted columns get the slots of the least recently used columns', () => {
    const pool = new SlotPool(6);
    const all = [true, true];
    for (const x of [0, 1, 2]) pool.take(0, x, 0, all, new Set());
    pool.pin(columnKey(0, 0, 0));
    pool.use(columnKey(0, 1, 0));
    const fourth = pool.take(0, 3, 0, [true, false], new Set());
    assert.deepEqual(
        [...fourth!.slots].map((slot) => slot >= 0),
        [true, false],
    );
    assert(pool.has(columnKey(0, 0, 0)) && pool.has(columnKey(0, 1, 0)) && !pool.has(columnKey(0, 2, 0)));
    assert.equal(pool.freeCount, 1);
    assert.equal(
        pool.take(0, 4, 0, all, new Set([columnKey(0, 1, 0), columnKey(0, 3, 0)])),
        null,
        'wanted columns keep their slots',
    );
    const held = [...pool.columns].flatMap(({ slots }) => [...slots]).filter((slot) => slot >= 0);
    assert.equal(new Set(held).size, held.length, 'no slot is given twice');
});

test('columns are asked for in few ranges, which skip few columns that nobody wants', () => {
    const weights = [10, 10, 0, 0, 10, 90, 10, 10];
    const ranges = (columns: number[], skipped: number, most: number) =>
        rangesOf(columns, 3, (column) => weights[column]!, skipped, most).map(({ first, end }) => `${first}-${end}`);
    assert.deepEqual(ranges([1, 0], 0, 100), ['0-6']);
    assert.deepEqual(ranges([0, 1, 4], 0, 100), ['0-15'], 'the columns in between are empty');
    assert.deepEqual(ranges([4, 6], 50, 500), ['12-15', '18-21'], 'the columns in between have too many bytes');
    assert.deepEqual(ranges([4, 6], 100, 500), ['12-21']);
    assert.deepEqual(ranges([0, 1, 6, 7], 0, 25), ['0-6', '18-24']);
    assert.deepEqual(ranges([0, 1], 0, 15), ['0-3', '3-6'], 'one range for both would be too large');
});
