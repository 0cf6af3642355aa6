import assert from 'node:assert/strict';
import test from 'node:test';

import { healthOf } from './health';

test('the button of live data tells their age, and is amber after 10 minutes', () => {
    assert.deepEqual(healthOf(120, null, false), { level: 'live', text: 'Live, 2 min old' });
    assert.deepEqual(healthOf(-300, null, false), { level: 'live', text: 'Live, 0 min old' });
    assert.equal(healthOf(599, null, false).level, 'live');
    assert.deepEqual(healthOf(600, null, false), { level: 'late', text: 'Live, 10 min old' });
    assert.deepEqual(healthOf(1800, null, false), { level: 'late', text: 'Newest, 30 min old' });
    assert.deepEqual(healthOf(3 * 3600, null, false), { level: 'late', text: 'Newest, 3 h old' });
});

test('a silent radar and a silent server are named, whatever the age (2026-11-28: a dead server looked alive)', () => {
    assert.deepEqual(healthOf(120, 840, false), { level: 'silent', text: 'Feed silent for 14 min' });
    assert.deepEqual(healthOf(120, null, true), { level: 'silent', text: 'Server silent' });
    assert.deepEqual(healthOf(120, 840, true), { level: 'silent', text: 'Server silent' });
});

test('old data, data of the future and no data are not live', () => {
    for (const ageS of [48 * 3600, 1e9, -601, NaN])
        assert.deepEqual(healthOf(ageS, null, false), { level: 'archive', text: 'Newest' });
    // A radar of an archive has been silent for years, which is not news.
    assert.equal(healthOf(1e9, 1e9, false).level, 'archive');
});
