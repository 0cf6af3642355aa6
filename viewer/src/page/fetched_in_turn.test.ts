import assert from 'node:assert/strict';
import test from 'node:test';

import { FetchedInTurn } from './fetched_in_turn';

// Returns fetches that end when the test says so.
function slow() {
    const begun: string[] = [];
    const ends = new Map<string, (value: string | Error) => void>();
    const fetch = (key: string) => () =>
        new Promise<string>((done, failed) => {
            begun.push(key);
            ends.set(key, (value) => (value instanceof Error ? failed(value) : done(value)));
        });
    return { begun, ends, fetch };
}
const rest = () => new Promise((done) => setTimeout(done, 0));

test('one item is fetched at a time, and wanted items before those ahead (2026-11-28: a loop of sweeps overloaded the server)', async () => {
    const { begun, ends, fetch } = slow();
    const store = new FetchedInTurn<string>(1000, (value) => value.length);
    for (const key of ['a', 'b', 'c']) void store.take(key, fetch(key), true);
    void store.take('c', fetch('c'), false);
    void store.take('d', fetch('d'), false);
    assert.deepEqual(begun, ['a']);
    for (const key of ['a', 'd', 'c', 'b']) {
        ends.get(key)!(key);
        await rest();
    }
    assert.deepEqual(begun, ['a', 'd', 'c', 'b']);
    assert.deepEqual(
        ['a', 'b', 'c', 'd'].map((key) => store.find(key)),
        ['a', 'b', 'c', 'd'],
    );
});

test('the most recently used items are kept, within the limit of bytes', async () => {
    const store = new FetchedInTurn<string>(10, (value) => value.length);
    for (const key of ['a', 'b']) await store.take(key, async () => 'x'.repeat(4), true);
    assert.equal(store.isSettled('a'), true);
    assert.deepEqual(
        [store.search((value) => value === 'xxxx'), store.search((value) => value === 'y')],
        ['xxxx', null],
    );
    await store.take('c', async () => 'x'.repeat(4), true);
    assert.deepEqual(
        ['a', 'b', 'c'].map((key) => store.isSettled(key)),
        [true, false, true],
    );
});

test('a failed item is settled, and can be fetched again later', async () => {
    let [now, tries] = [0, 0];
    const store = new FetchedInTurn<string>(
        10,
        (value) => value.length,
        () => now,
    );
    const fetch = async (): Promise<string> => {
        if (++tries === 1) throw new Error('gone');
        return 'here';
    };
    await store.take('a', fetch, false);
    assert.deepEqual([store.isSettled('a'), store.find('a'), String(store.errorOf('a'))], [true, null, 'Error: gone']);
    now = 5_000;
    await store.take('a', fetch, false);
    assert.deepEqual([tries, store.isNeeded('a')], [1, false]);
    now = 11_000;
    assert.equal(store.isNeeded('a'), true);
    await store.take('a', fetch, false);
    assert.deepEqual([store.find('a'), store.errorOf('a')], ['here', undefined]);
});
