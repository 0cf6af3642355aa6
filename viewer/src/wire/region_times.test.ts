// Tests the list of a region's times.
import assert from 'node:assert/strict';
import test from 'node:test';

const all = Array.from({ length: 600 }, (_, i) => new Date(Date.UTC(2026, 10, 28) + 300_000 * i).toISOString());
Object.assign(globalThis, {
    document: { baseURI: 'http://localhost/view/' },
    fetch: () => Promise.resolve(new Response(JSON.stringify({ moments: [{ moment: 'REF', times: all }] }))),
});

test('a region has all of its times (2026-11-28: the page called times before the newest 500 missing)', async () => {
    const { times } = await import('./api');
    assert.deepEqual(await times('region:-100,33,-95,37', 'REF', 500), { times: all, more: false });
    assert.deepEqual((await times('region:-100,33,-95,37', 'REF', 500, all[3])).times, all.slice(0, 4));
});
