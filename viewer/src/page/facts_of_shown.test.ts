// Tests how the page asks for facts of the shown grid.

import assert from 'node:assert/strict';
import test from 'node:test';

import type { App } from './app';

let isWell = false;
Object.assign(globalThis, {
    document: { baseURI: 'http://localhost/view/' },
    fetch: (): Promise<Response> =>
        Promise.resolve(
            new Response(JSON.stringify({ error: 'trouble', sites: [] }), {
                status: isWell ? 200 : 500,
                headers: { 'Stormcellar-Status': '' },
            }),
        ),
});

// 2026-11-28: after one failed answer, the page never showed the beam at the pointer, nor the volumes of a region.
test('facts are asked for again after a failure', async () => {
    const { FactsOfShown } = await import('./facts_of_shown');
    for (const domain of ['KBGM', 'region:-100,33,-95,37']) {
        const facts = new FactsOfShown({
            shown: { loaded: {}, domain, moment: 'REF', time: '2005-08-22T02:44:14Z' },
        } as unknown as App);
        const ask = (): Promise<unknown> => (domain === 'KBGM' ? facts.ask() : facts.askSites());
        isWell = false;
        assert.equal(await ask().catch(String), 'Error: trouble');
        isWell = true;
        await ask();
        assert((domain === 'KBGM' ? facts.known : facts.sites) !== null);
    }
});
