import assert from 'node:assert/strict';
import test from 'node:test';

import { EventText } from './events';

test('events are read from pieces of text with heartbeats between them', () => {
    const all = 'retry: 3000\nid: 5f-0\n\nid: 5f-1\nevent: mosaic\ndata: {"a": "b: c"}\n\n: heartbeat\nid: 5f-9\n\n';
    const whole = [
        { kind: '', id: '5f-0', data: '' },
        { kind: 'mosaic', id: '5f-1', data: '{"a": "b: c"}' },
        { kind: '', id: '5f-9', data: '' },
    ];
    for (let cut = 0; cut <= all.length; ++cut) {
        const text = new EventText();
        assert.deepEqual([...text.take(all.slice(0, cut)), ...text.take(all.slice(cut))], whole, String(cut));
    }
});
