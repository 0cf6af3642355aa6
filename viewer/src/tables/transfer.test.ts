import assert from 'node:assert/strict';
import test from 'node:test';

import { colorOf, extinctionPerM } from './color_table';
import { ColorTable } from '../wire/color_tables';
import { binCount, chooseBins, makeTransfer } from './transfer';
import { smooth } from '../testing/made_tables';

const stop = (from: number, r: number, g: number) => ({
    from,
    color: [r, g, 0, 255] as [number, number, number, number],
    until: [r, g, 0, 255] as [number, number, number, number],
});
const stepped: ColorTable = {
    ...smooth,
    stops: [stop(5, 255, 0), stop(10, 0, 255), stop(20, 128, 128)],
    end: 30,
    extinction: [
        { value: 5, per_km: 0.2 },
        { value: 20, per_km: 2 },
    ],
};
const quantization = { firstValue: -32, step: 0.5 };
const opacity = 1.5;
const stepM = 700;
const made = makeTransfer(stepped, quantization, { opacity, least: -Infinity }, stepM);
const entry = (front: number, back: number) => [
    ...made.entries.subarray(4 * (front * binCount + back), 4 * (front * binCount + back) + 4),
];
const binOf = (code: number) => Math.min(255, Math.max(0, Math.floor(made.binOffset + made.binSlope * code)));
const codeOf = (value: number) => (value - quantization.firstValue) / quantization.step + 3;

test('a bin begins at each stop, and bin 0 is clear', () => {
    const bins = chooseBins(stepped);
    for (const { from } of stepped.stops) {
        const place = (from - bins.lowest) / bins.width;
        assert(Math.abs(place - Math.round(place)) < 1e-9);
    }
    assert.equal(binOf(codeOf(4.5)), 0);
    assert.equal(binOf(codeOf(5)), 1);
    assert.deepEqual(entry(0, 0), [0, 0, 0, 0]);
});

test('a step through one value has the color and the optical depth of this value', () => {
    const value = 12;
    const bin = binOf(codeOf(value));
    const bins = chooseBins(stepped);
    const middle = bins.lowest + (bin - 0.5) * bins.width;
    const [r, g, , depth] = entry(bin, bin) as [number, number, number, number];
    const color = colorOf(stepped, middle)!;
    assert(Math.abs(r - color[0] / 255) < 1e-6 && Math.abs(g - color[1] / 255) < 1e-6);
    assert(Math.abs(depth - extinctionPerM(stepped, middle, opacity) * stepM) < 1e-6);
});

// Computes a step slowly and obviously, as many thin layers from front to back.
function layered(front: number, back: number): { color: [number, number]; depth: number } {
    const layers = 20000;
    const bins = chooseBins(stepped);
    let [red, green, through, depth] = [0, 0, 1, 0];
    for (let i = 0; i < layers; ++i) {
        const place = front + ((i + 0.5) / layers) * (back - front);
        const bin = Math.round(place);
        const value = bins.lowest + (bin - 0.5) * bins.width;
        const thin = bin < 1 ? 0 : (extinctionPerM(stepped, value, opacity) * stepM) / layers;
        const seen = through * -Math.expm1(-thin);
        const color = bin < 1 ? null : colorOf(stepped, value);
        if (color) {
            red += (seen * color[0]) / 255;
            green += (seen * color[1]) / 255;
        }
        through -= seen;
        depth += thin;
    }
    return { color: [red / (1 - through), green / (1 - through)], depth };
}

test('a step over many values equals many thin layers in their order', () => {
    for (const [front, back] of [
        [10, 200],
        [200, 10],
        [0, 90],
        [90, 0],
        [40, 41],
        [250, 3],
    ] as const) {
        const want = layered(front, back);
        const [r, g, , depth] = entry(front, back) as [number, number, number, number];
        assert(Math.abs(r - want.color[0]) < 2e-3 && Math.abs(g - want.color[1]) < 2e-3, `${front} to ${back}`);
        assert(Math.abs(depth - want.depth) < 1e-3 * Math.max(1, want.depth), `${front} to ${back}`);
    }
});

test('near values hide far values', () => {
    const towards = entry(10, 200);
    const away = entry(200, 10);
    assert.equal(towards[3], away[3]);
    assert(towards[0]! > away[0]!, 'red is the color of the weak end');
});

test('no value below the least visible code is visible', () => {
    assert.equal(binOf(made.leastVisibleCode - 1), 0);
    assert(binOf(made.leastVisibleCode) >= 1);
});

test('values below the threshold are clear, and other values look as without a threshold', () => {
    const above = makeTransfer(stepped, quantization, { opacity, least: 10 }, stepM);
    const bins = chooseBins(stepped, 10);
    assert.equal(bins.lowest, 10, 'the bins are those of a table that begins there');
    const look = (value: number) => {
        const bin = Math.min(255, Math.max(0, Math.floor(above.binOffset + above.binSlope * codeOf(value))));
        return [...above.entries.subarray(4 * bin * (binCount + 1), 4 * bin * (binCount + 1) + 4)];
    };
    assert.deepEqual(look(8), [0, 0, 0, 0]);
    assert.deepEqual(look(9.5), [0, 0, 0, 0]);
    for (const value of [10, 12, 25]) {
        assert.deepEqual(look(value).slice(0, 3), entry(binOf(codeOf(value)), binOf(codeOf(value))).slice(0, 3));
        const depth = extinctionPerM(stepped, value + 0.5 * bins.width, opacity) * stepM;
        assert(Math.abs(look(value)[3]! / depth - 1) < 0.01, `${value}`);
    }
    assert(above.leastVisibleCode > made.leastVisibleCode);
    assert(makeTransfer(stepped, quantization, { opacity, least: 1000 }, stepM).leastVisibleCode >= codeOf(1000));
});

test('a step between two equal values has the look of this value', () => {
    const transfer = makeTransfer(smooth, quantization, { opacity: 1, least: -Infinity }, 1000);
    for (const value of [10, 30, 50, 62]) {
        const bin = Math.floor(transfer.binOffset + transfer.binSlope * codeOf(value));
        const at = 4 * (bin * binCount + bin);
        const color = colorOf(smooth, value)!;
        for (let c = 0; c < 3; ++c) assert(Math.abs(transfer.entries[at + c]! - color[c]! / 255) < 0.02, `${value}`);
        assert(Math.abs(transfer.entries[at + 3]! / (1000 * extinctionPerM(smooth, value, 1)) - 1) < 0.05, `${value}`);
    }
    assert(transfer.leastVisibleCode > codeOf(4) && transfer.leastVisibleCode <= codeOf(5.5));
});

// Compares a step from end to end with the sum of many thin steps.
test('a step between two values shows all values between them in their order', () => {
    const stepM = 5000;
    const transfer = makeTransfer(smooth, quantization, { opacity: 1, least: -Infinity }, stepM);
    const binAt = (value: number) => Math.floor(transfer.binOffset + transfer.binSlope * codeOf(value));
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
            const seen = through * -Math.expm1((-extinctionPerM(smooth, value, 1) * stepM) / count);
            const color = colorOf(smooth, value)!;
            for (let c = 0; c < 3; ++c) sum[c]! += (seen * color[c]!) / 255;
            through -= seen;
        }
        const at = 4 * (binAt(from) * binCount + binAt(to));
        const alpha = -Math.expm1(-transfer.entries[at + 3]!);
        assert(Math.abs(alpha - (1 - through)) < 0.01, `${from} ${to}`);
        for (let c = 0; c < 3; ++c)
            assert(Math.abs(alpha * transfer.entries[at + c]! - sum[c]!) < 0.01, `${from} ${to} ${c}`);
    }
});
