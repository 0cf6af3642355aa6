import assert from 'node:assert/strict';
import test from 'node:test';
import { destination, geodesic, planeOf } from '../earth/projection';
import { addressOf, commandOf, stateOf, usualState } from './view_state';

// Flinders Peak to Buninyong, the usual example, on WGS84 instead of GRS80 (which changes micrometers).
const flinders = { latitudeDeg: -(37 + 57 / 60 + 3.7203 / 3600), longitudeDeg: 144 + 25 / 60 + 29.5244 / 3600 };
const buninyong = { latitudeDeg: -(37 + 39 / 60 + 10.1561 / 3600), longitudeDeg: 143 + 55 / 60 + 35.3839 / 3600 };

test('geodesics are those of the tables', () => {
    const { distanceM, azimuth } = geodesic(flinders, buninyong);
    assert(Math.abs(distanceM - 54972.271) < 0.002, `${distanceM}`);
    const degrees = ((azimuth * 180) / Math.PI + 360) % 360;
    assert(Math.abs(degrees - (306 + 52 / 60 + 5.37 / 3600)) < 2e-6, `${degrees}`);
    const there = destination(flinders, azimuth, distanceM);
    assert(
        Math.abs(there.latitudeDeg - buninyong.latitudeDeg) < 1e-9 &&
            Math.abs(there.longitudeDeg - buninyong.longitudeDeg) < 1e-9,
    );
});

test('places go to the plane and back in every projection', () => {
    const grid = {
        centerDeg: [38.5, -97.5] as [number, number],
        parallelsDeg: [33, 45] as [number, number],
        offsetCells: [12, -7.5] as [number, number],
        spacing: 1000,
        nx: 400,
        ny: 300,
    };
    for (const projection of [0, 1, 2]) {
        const plane = planeOf({ ...grid, projection, spacing: projection === 1 ? 0.01 : 1000 });
        for (const place of [
            { latitudeDeg: 38.5, longitudeDeg: -97.5 },
            { latitudeDeg: 41.25, longitudeDeg: -103.7 },
            { latitudeDeg: 30.1, longitudeDeg: -90.2 },
        ]) {
            const back = plane.toPlace(plane.toPlane(place)!);
            assert(
                Math.abs(back.latitudeDeg - place.latitudeDeg) < 1e-8 &&
                    Math.abs(back.longitudeDeg - place.longitudeDeg) < 1e-8,
                `${projection}`,
            );
        }
        const [x, y] = plane.toPlane({ latitudeDeg: 38.5, longitudeDeg: -97.5 })!;
        const width = projection === 1 ? 0.01 * 111_320 * Math.cos((38.5 * Math.PI) / 180) : 1000;
        assert(
            Math.abs(x + 12 * width) < 50 && Math.abs(y - 7.5 * (projection === 1 ? 1110 : 1000)) < 50,
            'the middle of the grid is the origin',
        );
    }
});

test('an address holds the whole view', () => {
    const state = {
        ...usualState,
        domain: 'KTLX',
        moment: 'VEL',
        time: '1999-05-03T23:56:21Z',
        opacity: 0.5,
        least: 20,
        colors: 'nws-velocity',
        camera: {
            ...usualState.camera,
            azimuthDeg: 12.25,
            zoom: 2.5,
            lookAtM: [1000, -2000, 3000] as [number, number, number],
        },
    };
    assert.deepEqual(stateOf('#' + addressOf(state)), state);
});

test('what makes no sense in an address is left at its usual value', () => {
    const state = stateOf(
        '#zoom=-3&tilt=steep&time=soon&azimuth=1e9&look-at-km=1,2&opacity=&domain=' + 'x'.repeat(500),
    );
    assert.deepEqual(state.camera, usualState.camera);
    assert.equal(state.time, 'latest');
    assert.equal(state.opacity, 1);
    assert.equal(state.domain.length, 100);
});

test('the command draws the same view', () => {
    const command = commandOf({ ...usualState, domain: 'KTLX', moment: 'REF' }, 796, 532, '');
    assert.equal(
        command,
        'stormcellar frame KTLX --moment REF --azimuth 180 --tilt 60 --zoom 1 --field-of-view 40 --exaggeration 5 --opacity 1 --light none --width 796 --height 532 -o KTLX.png',
    );
    const ofFile = commandOf(
        { ...usualState, domain: 'KTLX', moment: 'REF', time: '1999-05-03T23:56:21Z' },
        796,
        532,
        '',
        'KTLX19990503_235621.gz',
    );
    assert(ofFile.startsWith('stormcellar frame KTLX19990503_235621.gz --moment REF --azimuth'), ofFile);
});
