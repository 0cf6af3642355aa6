import assert from 'node:assert/strict';
import test from 'node:test';

import { colorOf, extinctionPerM } from './color_table';
import { ColorTable } from '../wire/color_tables';
import { smooth } from '../testing/made_tables';

const table: ColorTable = {
    ...smooth,
    stops: [
        { from: 5, color: [0, 0, 0, 255], until: [100, 200, 40, 255] },
        { from: 15, color: [9, 9, 9, 255], until: [9, 9, 9, 255] },
    ],
    extinction: [
        { value: 5, per_km: 1 },
        { value: 15, per_km: 3 },
    ],
};

test('colors blend from stop to stop, begin at the first stop and stay constant above the last', () => {
    assert.equal(colorOf(table, 4.99), null);
    assert.equal(colorOf(table, NaN), null);
    assert.deepEqual(colorOf(table, 5), [0, 0, 0, 255]);
    assert.deepEqual(colorOf(table, 10), [50, 100, 20, 255]);
    assert.deepEqual(colorOf(table, 15), [9, 9, 9, 255], 'a stop includes its lower bound');
    assert.deepEqual(colorOf(table, 900), [9, 9, 9, 255]);
});

test('extinction is linear between points, 0 below the first and constant above the last', () => {
    assert.equal(extinctionPerM(table, 4, 1), 0);
    assert.equal(extinctionPerM(table, 10, 1), 0.002);
    assert.equal(extinctionPerM(table, 10, 3), 0.006);
    assert.equal(extinctionPerM(table, 90, 1), 0.003);
});
