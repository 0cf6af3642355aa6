import assert from 'node:assert/strict';
import test from 'node:test';

import { texts } from './texts';

test('the page tells how far the volumes of a region are from the instant', () => {
    const { ofVolumes, sitesAt } = texts.start;
    assert.equal(ofVolumes([-180, 42]), 'moved from volumes 3 min earlier and 42 s later');
    assert.equal(ofVolumes([-400]), 'not moved: observed 7 min earlier');
    assert.equal(ofVolumes([0]), 'not moved');
    assert.equal(
        sitesAt([
            { site: 'KCCX', middlesS: [-60, 240] },
            { site: 'KDIX', middlesS: [300] },
        ]),
        'KCCX moved from volumes 60 s earlier and 4 min later; KDIX not moved: observed 5 min later',
    );
    const many = ['KAAA', 'KBBB', 'KCCC'].map((site, i) => ({ site, middlesS: [-100 * i, 200] }));
    assert.equal(
        sitesAt([...many, { site: 'KDDD', middlesS: [-600] }]),
        '3 sites moved from volumes at most 4 min away; not moved: KDDD observed 10 min earlier',
    );
});

test("the page gives the server's reason for each site that is left out (2026-11-28: the page made up a reason)", () => {
    const sites: [string, string][] = [
        ['KENX', 'it has no volume within 15 minutes'],
        ['ROP5', 'it has no grids of VEL'],
        ['KOKX', 'it has no volume within 15 minutes'],
        ['KBGM', ''],
    ];
    assert.equal(
        texts.start.leftOut(sites),
        'not in the picture: KENX, KOKX (they have no volume within 15 minutes), ROP5 (it has no grids of VEL), KBGM',
    );
});

test('the page does not say that a grid is loading if the grid is gone (2026-11-28: the page said so)', () => {
    assert.equal(
        texts.detail({ coarsest: 2, missing: 3, isGone: true }),
        'coarse: greatest of 4 x 4 cells; finer cells are no longer there',
    );
    assert.equal(
        texts.detail({ coarsest: 1, missing: 3, isGone: false }),
        'coarse: greatest of 2 x 2 cells; finer cells are loading',
    );
    assert.equal(texts.detail({ coarsest: 0, missing: 0, isGone: true }), '');
});

test('data of a radar whose clock is ahead are in the future, and not new (2026-11-28: they were "0 min ago")', () => {
    assert.equal(texts.start.age(-601, '2026-11-28T12:00:00Z'), 'in the future');
    assert.equal(texts.start.age(-599, '2026-11-28T12:00:00Z'), '0 min ago');
});

test('old data have a date, and new data an age (2026-11-28: "28 years ago")', () => {
    assert.equal(texts.start.age(47 * 3600, '1999-05-03T23:56:21Z'), '47 h ago');
    assert.equal(texts.start.age(49 * 3600, '1999-05-03T23:56:21Z'), '1999-05-03 23:56 UTC');
});

test('the page tells how much echo a grid or a sweep lacks', () => {
    const { leftOut } = texts.layers;
    assert.equal(leftOut('', null), '');
    assert.equal(leftOut(', ', { share: 0.123 }), ', weather only: 12 % of the echo left out');
    assert.equal(leftOut('', { share: -1 }), 'weather only', 'the sites of a mosaic differ');
});
