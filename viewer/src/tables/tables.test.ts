import assert from 'node:assert/strict';
import test from 'node:test';
import { colorOf, extinctionPerM } from './color_table';
import { ColorTable } from '../wire/color_tables';
import { binCount, makeTransfer } from './transfer';
import { advanced, at, followed, stopped, withTimes } from '../time/player';

const table: ColorTable = {
    name: 'made',
    moment: 'REF',
    unit: 'dBZ',
    stops: [
        { from: 5, color: [0, 0, 255, 255], until: [0, 255, 0, 255] },
        { from: 35, color: [255, 255, 0, 255], until: [255, 0, 0, 255] },
        { from: 65, color: [255, 255, 255, 255], until: [255, 255, 255, 255] },
    ],
    end: 80,
    bar_begin: 5,
    range_folded: [119, 0, 125, 255],
    extinction: [
        { value: 5, per_km: 0.01 },
        { value: 45, per_km: 0.25 },
        { value: 60, per_km: 4 },
    ],
};

test('colors and extinction go straight from stop to stop', () => {
    assert.equal(colorOf(table, 4.9), null);
    assert.equal(colorOf(table, NaN), null);
    assert.deepEqual(colorOf(table, 20), [0, 127.5, 127.5, 255]);
    assert.deepEqual(colorOf(table, 90), [255, 255, 255, 255]);
    assert(Math.abs(extinctionPerM(table, 25, 2) - 2 * 0.13e-3) < 1e-12);
    assert.equal(extinctionPerM(table, 4, 1), 0);
    assert.equal(extinctionPerM(table, 75, 1), 4e-3);
});

test('a step that stays in a value has that value’s look', () => {
    const transfer = makeTransfer(table, { firstValue: -32, step: 0.5 }, { opacity: 1, least: -Infinity }, 1000);
    for (const value of [10, 30, 50, 62]) {
        const code = 3 + (value + 32) / 0.5;
        const bin = Math.floor(transfer.binOffset + transfer.binSlope * code);
        const at = 4 * (bin * binCount + bin);
        const color = colorOf(table, value)!;
        for (let c = 0; c < 3; ++c) assert(Math.abs(transfer.entries[at + c]! - color[c]! / 255) < 0.02, `${value}`);
        assert(Math.abs(transfer.entries[at + 3]! / (1000 * extinctionPerM(table, value, 1)) - 1) < 0.05, `${value}`);
    }
    assert(transfer.leastVisibleCode > 3 + (4 + 32) / 0.5 && transfer.leastVisibleCode <= 3 + (5.5 + 32) / 0.5);
});

// The sum over many thin steps is what a step from end to end must be.
test('a step between two values shows all of them in their order', () => {
    const stepM = 5000;
    const transfer = makeTransfer(table, { firstValue: -32, step: 0.5 }, { opacity: 1, least: -Infinity }, stepM);
    const binOf = (value: number) => Math.floor(transfer.binOffset + transfer.binSlope * (3 + (value + 32) / 0.5));
    for (const [from, to] of [
        [20, 60],
        [60, 20],
        [40, 55],
    ] as const) {
        let through = 1;
        const sum = [0, 0, 0];
        const count = 20_000;
        for (let i = 0; i < count; ++i) {
            const value = from + ((i + 0.5) / count) * (to - from);
            const seen = through * -Math.expm1((-extinctionPerM(table, value, 1) * stepM) / count);
            const color = colorOf(table, value)!;
            for (let c = 0; c < 3; ++c) sum[c]! += (seen * color[c]!) / 255;
            through -= seen;
        }
        const entry = 4 * (binOf(from) * binCount + binOf(to));
        const alpha = -Math.expm1(-transfer.entries[entry + 3]!);
        assert(Math.abs(alpha - (1 - through)) < 0.01, `${from} ${to}`);
        for (let c = 0; c < 3; ++c)
            assert(Math.abs(alpha * transfer.entries[entry + c]! - sum[c]!) < 0.01, `${from} ${to} ${c}`);
    }
});

test('playback waits for what is not loaded', () => {
    const times = ['a', 'b', 'c'];
    let player = { ...withTimes(stopped, times), isPlaying: true, follows: false, at: 0 };
    const waiting = advanced(player, () => false);
    assert.equal(waiting.waitsFor, 'b');
    assert.equal(waiting.player.at, 0);
    player = advanced(player, (time) => time === 'b').player;
    assert.equal(player.at, 1);
    player = advanced({ ...player, at: 2 }, () => true).player;
    assert.equal(player.at, 0, 'it is a loop');
});

test('who follows sees the newest, others stay where they are', () => {
    const following = withTimes(stopped, ['a', 'b']);
    assert.equal(following.at, 1);
    assert.equal(withTimes(following, ['a', 'b', 'c']).at, 2);
    const staying = at(following, 0);
    assert.equal(withTimes(staying, ['a', 'b', 'c']).at, 0);
    assert.equal(withTimes(staying, ['b', 'c']).at, 0, 'a was evicted: the next one');
    assert.equal(followed(withTimes(staying, ['a', 'b', 'c'])).at, 2);
});
