import assert from 'node:assert/strict';
import test from 'node:test';

import { labeledOf, runsOf, shareOf } from './marks';

test('runs hold every time once', () => {
    assert.deepEqual(runsOf(0, 3), []);
    assert.deepEqual(runsOf(2, 3), [
        { from: 0, to: 0 },
        { from: 1, to: 1 },
    ]);
    for (const [count, most] of [
        [3, 3],
        [7, 3],
        [301, 300],
        [10_000, 300],
    ] as const) {
        const runs = runsOf(count, most);
        assert.ok(runs.length <= most, `${runs.length} runs`);
        assert.deepEqual(
            runs.flatMap(({ from, to }) => Array.from({ length: to - from + 1 }, (_, i) => from + i)),
            Array.from({ length: count }, (_, i) => i),
        );
    }
});

test('labels are at equal steps from the last time backward', () => {
    assert.deepEqual(labeledOf(0, 5), []);
    assert.deepEqual(labeledOf(1, 5), [0]);
    assert.deepEqual(labeledOf(5, 5), [0, 1, 2, 3, 4]);
    assert.deepEqual(labeledOf(6, 5), [1, 3, 5]);
    assert.deepEqual(labeledOf(9, 1), [8], 'room for one');
    assert.deepEqual(labeledOf(9, 0), [8], 'the newest even without room');
    for (let count = 2; count < 60; ++count)
        for (let most = 2; most < 20; ++most) assert.ok(labeledOf(count, most).length <= most, `${count}, ${most}`);
});

test('a place on the slider is within it', () => {
    assert.equal(shareOf(0, 1), 0);
    assert.equal(shareOf(1, 3), 0.5);
    assert.equal(shareOf(-0.5, 3), 0);
    assert.equal(shareOf(2.5, 3), 1);
});
