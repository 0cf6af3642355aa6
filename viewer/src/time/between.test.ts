import assert from 'node:assert/strict';
import test from 'node:test';

import { instantsBetween } from './between';

const stored = ['2016-06-01T15:00:25.232Z', '2016-06-01T15:04:40Z', '2016-06-01T16:00:00Z', '2016-06-01T16:02:30Z'];

test('instants between volumes are whole multiples, and volumes keep their times (2026-11-28: a volume was reported missing)', () => {
    assert.deepEqual(instantsBetween(stored, 120, new Set()), [
        '2016-06-01T15:00:25.232Z',
        '2016-06-01T15:02:00Z',
        '2016-06-01T15:04:00Z',
        '2016-06-01T15:04:40Z',
        '2016-06-01T16:00:00Z',
        '2016-06-01T16:02:00Z',
        '2016-06-01T16:02:30Z',
    ]);
});

test('instants without a frame are left out, and without volumes there are no instants', () => {
    assert.ok(!instantsBetween(stored, 60, new Set(['2016-06-01T15:03:00Z'])).includes('2016-06-01T15:03:00Z'));
    assert.deepEqual(instantsBetween([], 60, new Set()), []);
});

test('a volume at a whole multiple is listed once', () => {
    assert.deepEqual(instantsBetween(['2016-06-01T16:00:00Z', '2016-06-01T16:01:00Z'], 60, new Set()), [
        '2016-06-01T16:00:00Z',
        '2016-06-01T16:01:00Z',
    ]);
});
