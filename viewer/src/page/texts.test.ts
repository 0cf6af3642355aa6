import assert from 'node:assert/strict';
import test from 'node:test';

import { texts } from './texts';

test('the page tells how far the volumes of a region are from the instant', () => {
    const { ofVolumes, sitesAt } = texts.start;
    assert.equal(ofVolumes([-180, 42]), 'from volumes 3 min before and 42 s after');
    assert.equal(ofVolumes([-400]), 'as it was 7 min before');
    assert.equal(ofVolumes([0]), 'as it was');
    assert.equal(
        sitesAt([
            { site: 'KCCX', middlesS: [-60, 240] },
            { site: 'KDIX', middlesS: [300] },
        ]),
        'KCCX from volumes 60 s before and 4 min after; KDIX as it was 5 min after',
    );
    const many = ['KAAA', 'KBBB', 'KCCC'].map((site, i) => ({ site, middlesS: [-100 * i, 200] }));
    assert.equal(
        sitesAt([...many, { site: 'KDDD', middlesS: [-600] }]),
        '3 sites from volumes at most 4 min away; as they were: KDDD 10 min before',
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

test('the page does not say that a grid is loading if the grid is gone (2026-11-28: it did)', () => {
    assert.equal(
        texts.detail({ coarsest: 2, missing: 3, isGone: true }),
        'coarse: greatest of 4 x 4 cells, finer ones are gone',
    );
    assert.equal(
        texts.detail({ coarsest: 1, missing: 3, isGone: false }),
        'coarse: greatest of 2 x 2 cells, finer ones are loading',
    );
    assert.equal(texts.detail({ coarsest: 0, missing: 0, isGone: true }), '');
});

test('data of a radar whose clock is ahead are in the future, and not new (2026-11-28: they were "0 min ago")', () => {
    assert.equal(texts.start.age(-601), 'in the future');
    assert.equal(texts.start.age(-599), '0 min ago');
});

test('the page tells how much echo a grid or a sweep lacks', () => {
    const { leftOut } = texts.layers;
    assert.equal(leftOut('', null), '');
    assert.equal(leftOut(', ', { share: 0.123 }), ', weather only: 12 % of the echo left out');
    assert.equal(leftOut('', { share: -1 }), 'weather only', 'the sites of a mosaic differ');
});
