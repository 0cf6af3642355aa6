import assert from 'node:assert/strict';
import test from 'node:test';

import { outdatedBy } from './outdated';

const at = (minute: number) => `2026-11-28T10:${String(minute).padStart(2, '0')}:00Z`;

test('the old copy of a remade grid is outdated, even if another moment is shown (2026-11-28: it was shown)', () => {
    const isOld = outdatedBy('KTLX/VEL', at(10), [], 'KTLX/REF');
    assert.ok(isOld(`KTLX/VEL/${at(10)}`));
    for (const key of [`KTLX/REF/${at(10)}`, `KTL/VEL/${at(10)}`]) assert.ok(!isOld(key), key);
});

test('without a list of times, frames less than 30 minutes from the remade grid are outdated', () => {
    const isOld = outdatedBy('KTLX/VEL', at(31), [], 'KTLX/REF');
    for (const minute of [2, 30, 59]) assert.ok(isOld(`KTLX/VEL/${at(minute)}`), `${minute}`);
    assert.ok(!isOld(`KTLX/VEL/${at(0)}`));
});

test('a remade grid outdates the frames between it and its neighbors in time, and every region except the shown one', () => {
    const isOld = outdatedBy('KTLX/REF', at(10), [at(0), at(5), at(10), at(15)], 'KTLX/REF');
    for (const minute of [6, 10, 14]) assert.ok(isOld(`KTLX/REF/${at(minute)}`), `${minute}`);
    for (const minute of [0, 4, 5, 15, 16]) assert.ok(!isOld(`KTLX/REF/${at(minute)}`), `${minute}`);
    assert.ok(isOld(`region:-100,30,-90,40/REF/${at(0)}`));
    assert.ok(!outdatedBy('KTLX/REF', at(10), [], 'region:-100,30,-90,40/REF')(`region:-100,30,-90,40/REF/${at(0)}`));
});
