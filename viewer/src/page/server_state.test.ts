// The page knows which stations its server does not hear.
import assert from 'node:assert/strict';
import test from 'node:test';

import { ServerState } from './server_state';

test('a station of which the server cannot say whether it is silent stays as it was', () => {
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
