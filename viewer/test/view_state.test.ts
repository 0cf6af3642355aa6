import assert from 'node:assert/strict';
import test from 'node:test';

import { addressOf, commandOf, stateOf, usualState } from '../src/scene/view_state';

const chosen = {
    ...usualState,
    domain: 'north east&=#',
    moment: 'VEL',
    time: '2016-06-01T15:00:25.180Z',
    camera: { azimuthDeg: 217.25, tiltDeg: 71.5, zoom: 3.5, fieldOfViewDeg: 0, lookAtM: [12345, -6789, 4000] as [number, number, number] },
    hasGround: false,
    exaggeration: 2.5,
    opacity: 1.8,
    least: -12.5,
    colors: 'safe-velocity',
};

test('the address holds the whole view', () => {
    const back = stateOf(`#${addressOf(chosen)}`);
    assert.deepEqual({ ...back }, { ...chosen });
});

test('what makes no sense in an address is left at its usual value', () => {
    const state = stateOf('#time=never&tilt=1e9&zoom=NaN&azimuth=&opacity=-1&look-at-km=1,2&moment=<script>');
    assert.deepEqual(state.camera, usualState.camera);
    assert.equal(state.time, 'latest');
    assert.equal(state.opacity, usualState.opacity);
    assert.equal(stateOf(`#domain=${'x'.repeat(5000)}`).domain.length, 100);
});

test('an empty address is the usual view', () => {
    assert.deepEqual(stateOf(''), usualState);
});

test('the command names what stormcellar frame knows', () => {
    const command = commandOf({ ...chosen, domain: 'KLBB' }, 796, 532, 'safe-velocity');
    for (const part of ['stormcellar frame KLBB', '--moment VEL', '--azimuth 217.25', '--tilt 71.5', '--zoom 3.5', '--field-of-view 0', '--look-at-km 12.345,-6.789,4', '--exaggeration 2.5', '--opacity 1.8', '--colors safe-velocity', '--width 796', '--height 532'])
        assert(command.includes(part), `${part} in ${command}`);
});
