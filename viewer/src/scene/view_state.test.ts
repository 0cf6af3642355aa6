import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import test from 'node:test';

import { Layers, beyondCommand, usualLayers } from './layers';
import { isPrintable } from './shell';
import { isRegion, regionName } from '../wire/region';
import { addressOf, commandOf, isBeyondLimits, isUsualGrid, stateOf, usualState } from './view_state';

const chosen = {
    ...usualState,
    domain: 'north east&=#',
    moment: 'VEL',
    time: '2016-06-01T15:00:25.180Z',
    camera: {
        azimuthDeg: 217.25,
        tiltDeg: 71.5,
        zoom: 3.5,
        fieldOfViewDeg: 0,
        lookAtM: [12345, -6789, 4000] as [number, number, number],
    },
    hasGround: false,
    exaggeration: 2.5,
    opacity: 1.8,
    least: -12.5,
    colors: 'safe-velocity',
    overlays: ['warnings', 'a, b&c'],
};

test('the address holds every part of a view', () => {
    const back = stateOf(`#${addressOf(chosen)}`);
    assert.deepEqual({ ...back }, { ...chosen });
});

test('a parameter that makes no sense keeps its usual value', () => {
    for (const address of [
        '#time=never&tilt=1e9&zoom=NaN&azimuth=&opacity=-1&least=weak&look-at-km=1,2&moment=<script>',
        '#time=soon&tilt=steep&zoom=-3&azimuth=1e9&opacity=&look-at-km=1,2,x',
    ]) {
        const state = stateOf(address);
        assert.deepEqual(state.camera, usualState.camera);
        assert.deepEqual([state.time, state.opacity, state.least], ['latest', usualState.opacity, null]);
    }
    assert.equal(stateOf(`#domain=${'x'.repeat(5000)}`).domain.length, 100);
    assert.deepEqual(stateOf('#overlay=&overlay=b&overlay=a&overlay=b').overlays, ['b', 'a']);
});

test('an empty address gives the usual view', () => {
    assert.deepEqual(stateOf(''), usualState);
});

test('the command draws the same view', () => {
    const state = { ...usualState, domain: 'KTLX', moment: 'REF' };
    assert.equal(
        commandOf(state, 796, 532, ''),
        'stormcellar frame KTLX --moment REF --azimuth 180 --tilt 60 --zoom 1 --field-of-view 40 --exaggeration 5 --opacity 1 --light none --width 796 --height 532 -o KTLX.png',
    );
    const withCells = { ...state, layers: { ...state.layers, hasCells: true } };
    assert(commandOf(withCells, 796, 532, '').includes('--light none --overlay cells --width'));
    const ofFile = commandOf({ ...state, time: '1999-05-03T23:56:21Z' }, 796, 532, '', 'KTLX19990503_235621.gz');
    assert(ofFile.startsWith('stormcellar frame KTLX19990503_235621.gz --moment REF --azimuth'), ofFile);
    const command = commandOf({ ...chosen, domain: 'KLBB' }, 796, 532, 'safe-velocity');
    for (const part of [
        '--azimuth 217.25 --tilt 71.5 --zoom 3.5 --field-of-view 0',
        '--look-at-km 12.345,-6.789,4',
        '--exaggeration 2.5 --opacity 1.8',
        '--colors safe-velocity',
    ])
        assert(command.includes(part), `${part} in ${command}`);
});

// Returns the words of a command as a shell takes them.
const words = (command: string): string[] =>
    execFileSync('sh', ['-c', `printf '%s\\0' ${command}`], { encoding: 'utf8' })
        .split('\0')
        .slice(0, -1);

test('a shell reads each word of the command unchanged (2026-11-28: a name in a link ran commands)', () => {
    const names = [
        'KLBB20160601_150025_V06;touch pwned;:',
        'it\'s $(id) `id` "x" \\ * ~ # & | > <',
        '!!',
        ' ',
        '$HOME',
        '-o',
    ];
    for (const name of names) {
        const read = words(commandOf({ ...chosen, domain: name }, 796, 532, name, name));
        assert.deepEqual(read.slice(0, 5), ['stormcellar', 'frame', name.replace(/^-/, './-'), '--moment', 'VEL']);
        assert.equal(read[read.indexOf('--colors') + 1], name);
        assert.equal(read[read.length - 1], `${name}.png`);
    }
    assert.equal(words(commandOf({ ...chosen, domain: "x'y" }, 796, 532, '')).includes("x'y"), true);
    for (const name of ['a\nb', 'a\u001b[201~b', 'a\u0003', 'a\u202eb']) assert.equal(isPrintable(name), false);
    assert.equal(isPrintable("Zürich; it's"), true);
});

test('a region has exactly four numbers (2026-11-28: text after them went into commands)', () => {
    assert.equal(isRegion(regionName({ west: -100.25, south: -5, east: -95, north: 37.1234 })), true);
    for (const name of [
        'region:-100,33,-95,37,',
        'region:-100,33,-95,37,/REF#;touch pwned;:',
        'region:1,2,3',
        'region:1,2,3,x',
        'KLBB',
        'region:1e9,2,3,4',
    ])
        assert.equal(isRegion(name), false, name);
});

test('the command names the moment that the picture shows', () => {
    const momentIn = (moment: string, layers: Partial<Layers>) => {
        const state = { ...usualState, domain: 'KCRP', moment, layers: { ...usualLayers, ...layers } };
        return /--moment (\w+)/.exec(commandOf(state, 800, 600, ''))?.[1];
    };
    const sweep = { hasVolume: false, sweepDeg: 0.5 };
    assert.equal(momentIn('VELD', {}), 'VELD');
    assert.equal(momentIn('VELD', sweep), 'VELD');
    assert.equal(momentIn('VEL', { ...sweep, isSweepDealiased: true }), 'VELD');
    assert.equal(momentIn('VEL', sweep), 'VEL');
    assert.equal(momentIn('VEL', { isSweepDealiased: true }), 'VEL', 'the volume is not dealiased');
    assert.equal(momentIn('REF', { ...sweep, isSweepDealiased: true }), 'REF');
});

test('the command draws one layer, and other choices of layers have no command', () => {
    const sweep = { ...usualLayers, hasVolume: false, sweepDeg: 0.5 };
    assert.equal(beyondCommand(usualLayers, 1), null);
    assert.equal(beyondCommand(sweep, 1), null);
    assert.equal(
        beyondCommand(sweep, 2),
        'mosaic',
        'frame refuses a sweep of several radars (2026-11-28: its command was copied)',
    );
    assert.equal(beyondCommand({ ...sweep, hasVolume: true }, 1), 'several');
    assert.equal(beyondCommand({ ...sweep, sweepDeg: null }, 1), 'none');
    assert.equal(beyondCommand({ ...sweep, hasHaze: true }, 1), 'haze');
    assert.equal(beyondCommand({ ...sweep, hasFolded: true }, 1), 'haze');
    assert.equal(beyondCommand({ ...usualLayers, surface: { value: 40, moment: '' } }, 1), 'surface');
    assert.equal(
        beyondCommand({ ...usualLayers, crop: { westM: 0, eastM: 1, southM: 0, northM: 1, bottomM: 0, topM: 1 } }, 1),
        'box',
    );
});

test('a view that the program refuses has no command (2026-11-28: its command failed)', () => {
    const is = (part: object, layers: object, width = 796): boolean =>
        isBeyondLimits(
            { ...chosen, camera: { ...chosen.camera, ...part }, layers: { ...usualLayers, ...layers } },
            width,
            532,
        );
    const section = (degrees: number) => ({
        hasVolume: false,
        section: [
            { latitudeDeg: 35, longitudeDeg: -97 },
            { latitudeDeg: 35 + degrees, longitudeDeg: -97 },
        ],
    });
    assert.equal(is({}, {}), false);
    assert.equal(is({ fieldOfViewDeg: 0 }, {}), false);
    assert.equal(is({ fieldOfViewDeg: 0.5 }, {}), true);
    assert.equal(is({}, {}, 9000), true);
    assert.equal(is({}, { hasVolume: false, planeM: 61_000 }), true);
    assert.equal(is({}, section(0.001)), true);
    assert.equal(is({}, section(1)), false);
});

test('a time without a zone is UTC (2026-11-28: it was local time)', () => {
    const read = (time: string): string => stateOf(`#time=${encodeURIComponent(time)}`).time;
    for (const time of [
        '2016-06-01T15:00:26',
        '2016-06-01 15:00:26',
        '2016-06-01T15:00:26Z',
        '2016-06-01T10:00:26-05:00',
    ])
        assert.equal(Date.parse(read(time)), Date.UTC(2016, 5, 1, 15, 0, 26), time);
    for (const time of ['latest', 'x', '2016-13-01T00:00:00Z', '']) assert.equal(read(time), 'latest', time);
});

// 2026-11-28: if the service used another spacing, the command for a raw file drew another part of the country.
test('only the usual grid can be made from its raw file', () => {
    const levelsM = Float64Array.from({ length: 32 }, (_, level) => 500 * (level + 1));
    const usual = { nx: 460, ny: 460, spacing: 1000, levelsM };
    assert.equal(isUsualGrid(usual), true);
    assert.equal(isUsualGrid({ ...usual, nx: 600, ny: 600, spacing: 500 }), false);
    assert.equal(isUsualGrid({ ...usual, levelsM: levelsM.slice(1) }), false);
});
