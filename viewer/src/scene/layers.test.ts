import assert from 'node:assert/strict';
import test from 'node:test';

import {
    Layers,
    beyondCommand,
    croppedBox,
    layersAddress,
    layersOf,
    productOf,
    sectionOf,
    usualLayers,
} from './layers';
import { addressOf, commandOf, stateOf, usualState } from './view_state';

const all: Layers = {
    hasVolume: false,
    planeM: 3250,
    section: [
        { latitudeDeg: 35.25, longitudeDeg: -97.875 },
        { latitudeDeg: 35.5, longitudeDeg: -97.25 },
    ],
    surface: { value: -22.5, moment: 'VEL' },
    hasMaximum: true,
    sweepDeg: 1.45,
    isSweepDealiased: true,
    isSweepWeather: true,
    hasGlyphs: true,
    hasRotation: true,
    hasCells: true,
    sweepNumber: 3,
    crop: { westM: -40000, eastM: 10500, southM: -3000, northM: 60000, bottomM: 500, topM: 15000 },
    isLit: true,
    hasHaze: true,
    hasFolded: true,
};

test('the address holds every layer, except usual values', () => {
    assert.deepEqual(stateOf(addressOf({ ...usualState, layers: all })).layers, all);
    const first: Layers = { ...all, sweepNumber: 'first' };
    assert.deepEqual(layersOf(new URLSearchParams(layersAddress(first))), first);
    assert.deepEqual(layersAddress(usualLayers), []);
    assert.deepEqual(layersOf(new URLSearchParams('')), usualLayers);
});

test('parameters of layers that make no sense are ignored', () => {
    const nonsense =
        'height-km=up&section=91,0,1,1&surface=&elevation=1,2&crop-km=5,1,0,1,0,1&light=all&haze=yes&maximum=2';
    assert.deepEqual(layersOf(new URLSearchParams(nonsense)), usualLayers);
    assert.equal(sectionOf('35,-97,35,-97'), null);
    assert.equal(sectionOf('35,-97,36'), null);
    assert.equal(layersOf(new URLSearchParams(`surface=5&surface-moment=${'x'.repeat(99)}`)).surface!.moment.length, 8);
});

test('the command draws the glyphs of a sweep of velocities', () => {
    const layers = { ...usualLayers, hasVolume: false, sweepDeg: 0.5, hasGlyphs: true };
    const command = (moment: string, change: Partial<Layers>) =>
        commandOf({ ...usualState, domain: 'KTLX', moment, layers: { ...layers, ...change } }, 800, 600, '');
    assert(command('VEL', {}).includes('--product ppi --elevation 0.5 --glyphs '));
    assert(!command('REF', {}).includes('--glyphs'));
    assert(!command('VEL', { sweepDeg: null, planeM: 3000 }).includes('--glyphs'));
    assert(command('REF', { hasVolume: true, sweepDeg: null, hasRotation: true }).includes(' --rotation '));
    assert.equal(beyondCommand({ ...usualLayers, hasRotation: true }, 1), null);
    assert.equal(beyondCommand({ ...usualLayers, hasVolume: false, hasRotation: true }, 1), 'surface');
});

test('the command for a sweep leaves out the same echo as the shown sweep; other commands leave out no echo', () => {
    const command = (change: Partial<Layers>) =>
        productOf({ ...usualLayers, hasVolume: false, isSweepWeather: true, ...change })!.join(' ');
    assert.equal(command({ sweepDeg: 0.5 }), '--product ppi --elevation 0.5 --quality 0.5');
    assert.equal(command({ sweepDeg: 0.5, isSweepWeather: false }), '--product ppi --elevation 0.5');
    assert.equal(command({ sweepDeg: 0.5, sweepNumber: 'first' }), '--product ppi --elevation 0.5 --quality 0.5');
    assert.equal(command({ hasMaximum: true }), '--product composite');
});

test('the command draws one flat layer, or the volume with its light', () => {
    const command = (layers: Partial<Layers>) =>
        commandOf(
            { ...usualState, domain: 'KTLX', moment: 'REF', layers: { ...usualLayers, ...layers } },
            800,
            600,
            '',
        );
    assert(command({}).includes('--light none'));
    assert(command({ isLit: true, hasHaze: true }).includes('--light gradient --sun 245,40 --haze'));
    const section = command({ ...all, hasVolume: false });
    assert(section.includes('--product section --section 35.25,-97.875,35.5,-97.25'));
    assert(!section.includes('--azimuth'));
    assert.deepEqual(productOf({ ...usualLayers, hasVolume: false, planeM: 3000 }), [
        '--product',
        'cappi',
        '--height-km',
        '3',
    ]);
    assert.equal(productOf({ ...usualLayers, planeM: 3000 }), null);
});

test('a crop stays in the box of the grid', () => {
    const box = { westM: -10, eastM: 10, southM: -20, northM: 20, bottomM: 0, topM: 5 };
    assert.deepEqual(croppedBox(box, null), box);
    assert.deepEqual(croppedBox(box, { westM: -5, eastM: 50, southM: -50, northM: 1, bottomM: 1, topM: 9 }), {
        westM: -5,
        eastM: 10,
        southM: -20,
        northM: 1,
        bottomM: 1,
        topM: 5,
    });
});
