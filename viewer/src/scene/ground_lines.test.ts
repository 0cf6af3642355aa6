// Tests which kinds of lines of the map a view shows.

import assert from 'node:assert/strict';
import test from 'node:test';

import { ViewGeometry, usualCamera } from '../camera/geometry';
import { shownKinds } from './ground_lines';

const dense = (metersPerPixel: number, grain = 1): string[] => {
    const half = (300 * metersPerPixel) / 1.04;
    const box = { halfXM: half, halfYM: half, bottomM: 0, topM: 1000 };
    const geometry = new ViewGeometry(box, { ...usualCamera, tiltDeg: 0 }, 1, 600, 600);
    assert(Math.abs(geometry.metersPerPixel - metersPerPixel) < 1e-6);
    const shown = shownKinds(geometry, grain);
    assert((['state', 'coast', 'ring', 'border'] as const).every((kind) => shown.has(kind)));
    return (['county', 'interstate', 'highway'] as const).filter((kind) => shown.has(kind));
};

test('lines are shown where they are not too dense', () => {
    assert.deepEqual(dense(2600), []);
    assert.deepEqual(dense(2400), ['interstate']);
    assert.deepEqual(dense(1400), ['county', 'interstate']);
    assert.deepEqual(dense(560), ['county', 'interstate']);
    assert.deepEqual(dense(540), ['county', 'interstate', 'highway']);
    // Coarse pixels do not hide lines.
    assert.deepEqual(dense(1080, 2), ['county', 'interstate', 'highway']);
});
