// Tests how the page keeps the list of silent stations.
import assert from 'node:assert/strict';
import test from 'node:test';

import { ServerState } from './server_state';

test('a station keeps its state if the server does not know whether the station is silent', () => {
    const server = new ServerState(() => undefined);
    server.takeSilences([
        ['KBGM', 900],
        ['KENX', 900],
    ]);
    server.takeSilences([
        ['KBGM', undefined],
        ['KTLX', undefined],
    ]);
    assert.deepEqual([...server.silentSince.keys()], ['KBGM']);
});
