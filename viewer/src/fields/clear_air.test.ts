import assert from 'node:assert/strict';
import test from 'node:test';

import { isClearAir } from './clear_air';
import { usualLayers, layersAddress, layersOf, toggledFolded, veilsFolded } from '../scene/layers';
import { readPackedGrid } from '../wire/packed_grid';
import { slantedGrid } from '../testing/written_grid';

test('weak echo is clear air, but storms are not (2026-11-28: clear air looked as if nothing had come)', () => {
    const grid = readPackedGrid(slantedGrid(40, 36, 20));
    assert.equal(isClearAir(grid), true); // at most 16 dBZ
    assert.equal(isClearAir({ ...grid, firstValue: grid.firstValue + 30 }), false); // up to 46 dBZ
});

test('the area of echo in a halved grid is an estimate (2026-11-28: grids in parts had no rule)', () => {
    const grid = readPackedGrid(slantedGrid(16, 16, 1));
    const [few, many] = [60, 200].map((count) => ({
        ...grid,
        spacing: 2000,
        firstValue: -12,
        step: 1,
        codes: grid.codes.map((_, i) => (i % 16 === 0 && i < 16 * count ? 40 : 1)),
    }));
    assert.equal(isClearAir({ ...few!, halvings: 1 }), true); // 60 to 240 km2
    assert.equal(isClearAir({ ...few!, halvings: 0 }), false); // 240 km2
    assert.equal(isClearAir({ ...many!, halvings: 1 }), false); // 200 to 800 km2
});

test('range folded air veils a volume of velocities unless the user turns the veil off (2026-11-28: such air looked clear)', () => {
    for (const [moment, veils] of [
        ['VEL', true],
        ['SW', true],
        ['REF', false],
    ] as const)
        assert.equal(veilsFolded(usualLayers, moment), veils);
    assert.equal(veilsFolded({ ...usualLayers, hasVolume: false }, 'VEL'), false);
    for (const hasFolded of [true, false, null]) {
        const layers = layersOf(new URLSearchParams(layersAddress({ ...usualLayers, hasFolded })));
        assert.equal(layers.hasFolded, hasFolded);
    }
    assert.equal(veilsFolded({ ...usualLayers, hasFolded: false }, 'VEL'), false);
    assert.deepEqual(
        [toggledFolded(usualLayers, 'REF'), toggledFolded({ ...usualLayers, hasFolded: true }, 'REF')],
        [true, null],
    );
    assert.deepEqual(
        [toggledFolded(usualLayers, 'VEL'), toggledFolded({ ...usualLayers, hasFolded: false }, 'VEL')],
        [false, null],
    );
});
