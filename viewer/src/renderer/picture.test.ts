import assert from 'node:assert/strict';
import test from 'node:test';

import { drawParts, inStrips, nextRows } from './picture';

test('strips have more rows if they are fast, and fewer if they are slow', () => {
    assert.equal(nextRows(64, 90), 64);
    assert.equal(nextRows(64, 1), 128);
    assert.equal(nextRows(64, 180), 32);
    assert.equal(nextRows(64, 20_000), 8);
});

test('strips cover each row once', async () => {
    for (const ms of [0, 30, 1000]) {
        const rows: number[] = [];
        const parts = inStrips(337, (from, to) => {
            for (let row = from; row < to; ++row) rows.push(row);
        });
        for (let step = parts.next(ms); !step.done; step = parts.next(ms));
        assert.deepEqual(
            rows,
            Array.from({ length: 337 }, (_, row) => row),
        );
    }
});

test('a picture that is stopped draws no further strip', async () => {
    let strips = 0;
    const parts = () => inStrips(1000, () => ++strips);
    assert.equal(
        await drawParts(
            parts(),
            () => Promise.resolve(),
            () => strips === 2,
        ),
        false,
    );
    assert.equal(strips, 2);
    assert.equal(
        await drawParts(
            parts(),
            () => Promise.resolve(),
            () => false,
        ),
        true,
    );
});
