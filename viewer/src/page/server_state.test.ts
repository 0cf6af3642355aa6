// Tests how the page keeps the list of silent stations.
import assert from 'node:assert/strict';
import test from 'node:test';

import { ServerState } from './server_state';

test('a station stays silent or not if the server does not know', () => {
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
