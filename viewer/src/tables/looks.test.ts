import assert from 'node:assert/strict';
import test from 'node:test';

import { lookCount, lookOver, looksOf } from './looks';
import { ColorTable } from '../wire/color_tables';
import { smooth } from '../testing/made_tables';

test('looks have the colors of values, and are clear below the table and the threshold', () => {
    const table: ColorTable = {
        ...smooth,
        end: 20,
        stops: [
            { from: 5, color: [255, 0, 0, 255], until: [255, 0, 0, 255] },
            { from: 10, color: [0, 0, 255, 51], until: [0, 0, 255, 51] },
        ],
    };
    const looks = looksOf(table, -100);
    assert.equal(looks.rgba.length, 4 * lookCount);
    assert.equal(lookOver(looks, 4.9, [0, 0, 0]), null);
    assert.deepEqual(lookOver(looks, 5, [0, 0, 0]), [255, 0, 0]);
    assert.deepEqual(lookOver(looks, 9.98, [0, 0, 0]), [255, 0, 0]);
    assert.deepEqual(lookOver(looks, 10, [0, 0, 0]), [0, 0, 51]);
    assert.deepEqual(lookOver(looks, 99, [100, 0, 0]), [80, 0, 51]);
    for (const least of [8, 8.5, 7.3]) {
        assert.equal(lookOver(looksOf(table, least), least - 0.01, [0, 0, 0]), null);
        assert.deepEqual(lookOver(looksOf(table, least), least, [0, 0, 0]), [255, 0, 0]);
    }
});
