import assert from 'node:assert/strict';
import test from 'node:test';

import { texts } from './texts';

test('of a region is told how far the volumes of each site are from the instant', () => {
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

test('each site that is left out of a region has the reason that the server gives (2026-11-28: it was made up)', () => {
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

test('of a grid that is gone nothing is said to be loading (2026-11-28: it was)', () => {
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

test('a radar whose clock is ahead is in the future, and not new (2026-11-28: it was of 0 min ago)', () => {
    assert.equal(texts.start.age(-601), 'in the future');
    assert.equal(texts.start.age(-599), '0 min ago');
});
