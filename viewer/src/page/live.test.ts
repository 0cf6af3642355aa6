// Tests several pages of one browser, which share a channel.
import assert from 'node:assert/strict';
import test from 'node:test';

import type { App } from './app';
import { ServerState } from './server_state';

const server = {
    isUp: true,
    isHanging: false,
    waits: new Map<number, number>(),
    streams: new Set<ReadableStreamDefaultController<Uint8Array>>(),
};
// Lets the test end while timers and channels of its pages are open.
const unref = <Waits>(waits: Waits): Waits => ((waits as unknown as { unref: () => void }).unref(), waits);
Object.assign(globalThis, {
    window: {
        setTimeout: (act: () => void, ms: number) => unref(setTimeout(act, server.waits.get(ms) ?? ms)),
        clearTimeout,
    },
    BroadcastChannel: class extends BroadcastChannel {
        constructor(name: string) {
            super(name);
            unref(this);
        }
    },
    document: { baseURI: 'http://localhost/view/' },
    fetch: (url: string, options: RequestInit): Promise<Response> => {
        if (!server.isUp) return Promise.reject(new TypeError('no answer'));
        if (server.isHanging)
            return new Promise((_, failed) =>
                options.signal?.addEventListener('abort', () => failed(new TypeError('aborted'))),
            );
        if (!url.includes('events'))
            return Promise.resolve(
                new Response('{"stations":[]}', { headers: { Date: new Date(Date.now() + 3600e3).toUTCString() } }),
            );
        const body = new ReadableStream<Uint8Array>({
            start(stream) {
                server.streams.add(stream);
                options.signal?.addEventListener('abort', () => {
                    if (server.streams.delete(stream)) stream.error(new TypeError('aborted'));
                });
            },
        });
        return Promise.resolve(new Response(body, { headers: { 'Content-Type': 'text/event-stream' } }));
    },
});

const pause = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));
async function open(): Promise<{ server: ServerState; asked: () => number; failed: string[] }> {
    const { Live } = await import('./live');
    let asked = 0;
    const failed: string[] = [];
    const state = new ServerState(() => undefined);
    const app = {
        server: state,
        hasLists: false,
        fail: (error: Error) => failed.push(error.message),
        news: {
            catchUp: () => (++asked, server.isUp ? Promise.resolve() : Promise.reject(new TypeError('no answer'))),
        },
    };
    void new Live(app as unknown as App, Promise.resolve()).hear();
    return { server: state, asked: () => asked, failed };
}

// 2026-11-28: six pages used all six connections of a browser for events, and none loaded anything.
test('three pages of a browser listen, and the others ask for lists', async () => {
    const first = await open();
    await pause(1200);
    const unknown = new TextEncoder().encode('event: moon_rose\nid: 1-1\ndata: {}\n\n');
    for (const stream of server.streams) stream.enqueue(unknown);
    const pages = [first, ...(await Promise.all([open(), open(), open(), open()]))]; // all at once
    await pause(1500);
    assert.equal(server.streams.size, 3);
    assert.deepEqual(first.failed, ['moon_rose: no such event']);
    const withPlace = pages.filter((page) => page.asked() === 0);
    assert.equal(withPlace.length, 3);
    assert.equal(withPlace.includes(first), true);
    // 2026-11-28: pages without a stream computed ages by the clock of the browser.
    assert.equal(
        pages.every((page) => page.server.nowMs > Date.now() + 3500e3),
        true,
    );
    assert.equal(
        pages.some((page) => page.server.isCutOff),
        false,
    );
    server.isUp = false;
    for (const stream of server.streams) stream.error(new TypeError('gone'));
    await pause(100);
    assert.equal(
        withPlace.every((page) => page.server.isCutOff),
        true,
    );
});

// 2026-11-28: the fourth page of a browser did not say that the server hung, and looked live.
test('a page without a stream tells that the server hangs', async () => {
    await pause(3500); // the pages of the test above listen again
    server.isUp = true;
    server.waits.set(30_000, 500);
    const pages = await Promise.all([open(), open(), open(), open()]);
    await pause(1400);
    const without = pages.find((page) => page.asked() > 0)!;
    assert.equal(without.server.isCutOff, false);
    server.isHanging = true;
    server.waits.set(40_000, 1300); // longer than a page needs to find that it has no place
    await pause(4000);
    assert.equal(without.server.isCutOff, true);
});
