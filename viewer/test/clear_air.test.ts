import assert from 'node:assert/strict';
import test from 'node:test';

import { isClearAir } from '../src/fields/clear_air';
import { usualLayers, layersAddress, layersOf, toggledFolded, veilsFolded } from '../src/scene/layers';
import { readPackedGrid } from '../src/wire/packed_grid';
import { makeGrid } from './made_grid';

test('weak echo is clear air, storms are not (2026-11-28: clear air looked as if nothing had come)', () => {
    const grid = readPackedGrid(makeGrid(40, 36, 20).bytes);
    assert.equal(isClearAir(grid), true); // at most 16 dBZ
    assert.equal(isClearAir({ ...grid, firstValue: grid.firstValue + 30 }), false); // up to 46 dBZ
});

test('range folded air veils velocities unless it is told not to (2026-11-28: it looked clear)', () => {
    for (const [moment, veils] of [['VEL', true], ['SW', true], ['REF', false]] as const) assert.equal(veilsFolded(usualLayers, moment), veils);
    assert.equal(veilsFolded({ ...usualLayers, hasVolume: false }, 'VEL'), false);
    for (const hasFolded of [true, false, null]) {
        const layers = layersOf(new URLSearchParams(layersAddress({ ...usualLayers, hasFolded })));
        assert.equal(layers.hasFolded, hasFolded);
    }
    assert.equal(veilsFolded({ ...usualLayers, hasFolded: false }, 'VEL'), false);
    assert.deepEqual([toggledFolded(usualLayers, 'REF'), toggledFolded({ ...usualLayers, hasFolded: true }, 'REF')], [true, null]);
    assert.deepEqual([toggledFolded(usualLayers, 'VEL'), toggledFolded({ ...usualLayers, hasFolded: false }, 'VEL')], [false, null]);
});
