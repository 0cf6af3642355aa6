import assert from 'node:assert/strict';
import test from 'node:test';

import { exposureOf } from './exposure';

test('the exposure keeps the mean lightness', () => {
    const pixels = (factor: number) =>
        new Uint8Array(Array.from({ length: 50 }, (_, i) => [100 + i, Math.round(127.5 * factor), 200, 255]).flat());
    assert(Math.abs(exposureOf(pixels(1)) - 1) < 0.01);
    assert(Math.abs(exposureOf(pixels(0.8)) * 0.8 - 1) < 0.01);
    assert.equal(exposureOf(new Uint8Array(80)), 1);
});
