import assert from 'node:assert/strict';
import test from 'node:test';

import { Governor } from './governor';
import { Rung, rungs } from './ladder';

const rung = (name: string, cost: number, dE: number): Rung => ({
    name,
    slices: 1,
    grain: 1,
    isNearest: false,
    halvings: 0,
    cost,
    dE,
});
const three = [rung('exact', 1, 0.5), rung('middle', 0.5, 2), rung('fast', 0.1, 6)];
function governorAfter(exactMs: number, mostDE = 10, all = three): Governor {
    const governor = new Governor(all, 50, mostDE);
    governor.took(three[0]!, exactMs);
    return governor;
}

test('a view at rest is drawn by the first rung, however long it takes', () => {
    assert.equal(governorAfter(5000).next(false).name, 'exact');
});

test('a moving view is drawn by the most exact rung that is in time', () => {
    const governor = governorAfter(90);
    assert.equal(governor.next(true).name, 'middle');
    for (let i = 0; i < 20; ++i) governor.took(three[1]!, 200);
    assert.equal(governor.next(true).name, 'fast');
});

test('if no rung is in time, the fastest is taken', () => {
    assert.equal(governorAfter(100_000).next(true).name, 'fast');
});

test('a rung whose error is not allowed is never taken', () => {
    assert.equal(governorAfter(100_000, 3).next(true).name, 'middle');
    assert.equal(governorAfter(100_000, 0.1).next(true).name, 'exact');
});

test('a moving view never costs more than a view at rest', () => {
    assert.equal(governorAfter(1, 10, [...three, rung('lavish', 3, 0.1)]).next(true).name, 'exact');
});

test('near the limit the rung does not alternate', () => {
    const governor = governorAfter(101);
    assert.equal(governor.next(true).name, 'fast');
    for (let i = 0; i < 20; ++i) governor.took(three[2]!, 9.9);
    assert.equal(governor.next(true).name, 'fast', 'the middle rung would just fit');
    for (let i = 0; i < 20; ++i) governor.took(three[2]!, 7);
    assert.equal(governor.next(true).name, 'middle');
});

test('the first rung has cost 1 and draws in full detail, and names are unique', () => {
    assert.equal(rungs[0]!.cost, 1);
    assert.deepEqual([rungs[0]!.grain, rungs[0]!.isNearest, rungs[0]!.halvings], [1, false, 0]);
    assert.equal(new Set(rungs.map(({ name }) => name)).size, rungs.length);
});
