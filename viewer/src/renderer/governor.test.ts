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

test('a picture that stands still is exact, however long it takes', () => {
    const governor = new Governor(three, 50, 10);
    governor.took(three[0]!, 5000);
    assert.equal(governor.next(false).name, 'exact');
});

test('while the camera moves the most exact rung is taken that is drawn in time', () => {
    const governor = new Governor(three, 50, 10);
    governor.took(three[0]!, 90);
    assert.equal(governor.next(true).name, 'middle');
    for (let i = 0; i < 20; ++i) governor.took(three[1]!, 200);
    assert.equal(governor.next(true).name, 'fast');
});

test('where none is drawn in time the fastest is taken', () => {
    const governor = new Governor(three, 50, 10);
    governor.took(three[0]!, 100_000);
    assert.equal(governor.next(true).name, 'fast');
});

test('a rung whose error is not allowed is never taken', () => {
    const governor = new Governor(three, 50, 3);
    governor.took(three[0]!, 100_000);
    assert.equal(governor.next(true).name, 'middle');
    const strict = new Governor(three, 50, 0.1);
    strict.took(three[0]!, 100_000);
    assert.equal(strict.next(true).name, 'exact');
});

test('nothing that moves is drawn with more effort than what stands still', () => {
    const governor = new Governor([...three, rung('lavish', 3, 0.1)], 50, 10);
    governor.took(three[0]!, 1);
    assert.equal(governor.next(true).name, 'exact');
});

test('near the limit the picture does not go to and fro', () => {
    const governor = new Governor(three, 50, 10);
    governor.took(three[0]!, 101);
    assert.equal(governor.next(true).name, 'fast');
    for (let i = 0; i < 20; ++i) governor.took(three[2]!, 9.9);
    assert.equal(governor.next(true).name, 'fast', 'the middle rung would just fit');
    for (let i = 0; i < 20; ++i) governor.took(three[2]!, 7);
    assert.equal(governor.next(true).name, 'middle');
});

test('what a still picture is drawn by is in the ladder first, and what others cost is told by it', () => {
    assert.equal(rungs[0]!.cost, 1);
    assert.deepEqual([rungs[0]!.grain, rungs[0]!.isNearest, rungs[0]!.halvings], [1, false, 0]);
    assert.equal(new Set(rungs.map(({ name }) => name)).size, rungs.length);
});
