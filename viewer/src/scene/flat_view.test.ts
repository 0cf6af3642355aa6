import assert from 'node:assert/strict';
import test from 'node:test';

import { elsewhere, switched } from './flat_view';
import { ViewState, addressOf, stateOf, usualState } from './view_state';

const solid: ViewState = {
    ...usualState,
    domain: 'KLBB',
    moment: 'REF',
    camera: { azimuthDeg: 217, tiltDeg: 71, zoom: 3, fieldOfViewDeg: 40, lookAtM: [12000, -7000, 4000] },
    layers: { ...usualState.layers, hasMaximum: true, hasCells: true, isSweepWeather: true },
};

test('2D is a map of the lowest tilt at the same place, with north up', () => {
    const { camera, layers, isFlat } = switched(solid, true, null);
    assert.deepEqual(camera, { ...solid.camera, azimuthDeg: 180, tiltDeg: 0, fieldOfViewDeg: 0 });
    assert.deepEqual(
        [isFlat, layers.hasVolume, layers.hasMaximum, layers.sweepDeg, layers.hasCells, layers.isSweepWeather],
        [true, false, false, 0.5, true, true],
    );
});

test('a sweep that is shown in 3D is also the first that 2D shows', () => {
    const layers = { ...solid.layers, sweepDeg: 2.4, sweepNumber: 7 };
    const flat = switched({ ...solid, layers }, true, null);
    assert.deepEqual([flat.layers.sweepDeg, flat.layers.sweepNumber], [2.4, 7]);
});

test('camera and layers of 2D and 3D come back', () => {
    const flat = switched(solid, true, null);
    const back = switched(flat, false, solid);
    assert.deepEqual(back, solid);
    assert.deepEqual(switched(back, true, flat), flat);
});

test('a link to 2D leads to the usual view in 3D of the same place', () => {
    const first = switched(stateOf('#view=2d&zoom=4&look-at-km=10,20,5'), false, null);
    assert.deepEqual(first.camera, { ...usualState.camera, zoom: 4, lookAtM: [10000, 20000, 5000] });
    assert.deepEqual(first.layers, usualState.layers);
});

test('the address holds 2D, and a short address shows the lowest tilt', () => {
    const flat = switched(solid, true, null);
    assert.deepEqual(stateOf(`#${addressOf(flat)}`), flat);
    const { camera, layers } = stateOf('#view=2d&azimuth=90&tilt=60&field-of-view=40');
    assert.deepEqual([camera.azimuthDeg, camera.tiltDeg, camera.fieldOfViewDeg], [180, 0, 0]);
    assert.deepEqual([layers.hasVolume, layers.sweepDeg], [false, 0.5]);
    for (const change of [{ hasVolume: true }, { sweepDeg: null, isSweepWeather: false }]) {
        const other = { ...flat, layers: { ...flat.layers, ...change } };
        assert.deepEqual(stateOf(`#${addressOf(other)}`), other);
    }
    assert.equal(stateOf(`#${addressOf(solid)}`).isFlat, false);
});

test('another domain has other places and other cuts', () => {
    const { camera, layers } = elsewhere({ ...solid, layers: { ...solid.layers, sweepDeg: 2.4, sweepNumber: 7 } });
    assert.deepEqual([camera.lookAtM, camera.zoom, camera.azimuthDeg], [null, 1, 217]);
    assert.deepEqual([layers.sweepDeg, layers.sweepNumber], [2.4, null]);
});
