// Tests that the page asks a busy server again.
import assert from 'node:assert/strict';
import test from 'node:test';

const answers: Response[] = [];
Object.assign(globalThis, {
    document: { baseURI: 'http://localhost/view/' },
    fetch: () => Promise.resolve(answers.shift()),
});
const busy = (): Response =>
    new Response('{}', { status: 503, headers: { 'Stormcellar-Status': '503', 'Retry-After': '0' } });

test('a frame between volumes is asked for again while the server is busy (2026-11-28: loops stalled)', async () => {
    const { packedBetween } = await import('./api');
    answers.push(busy(), busy(), new Response('bytes'));
    assert.equal((await packedBetween('KTLX', 'REF', '2026-11-28T10:01:00Z')).byteLength, 5);
    assert.equal(answers.length, 0);
});
