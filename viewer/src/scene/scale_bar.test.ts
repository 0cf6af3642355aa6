import assert from 'node:assert/strict';
import test from 'node:test';

import { Camera, ViewGeometry, usualCamera } from '../camera/geometry';
import { planeOf } from '../earth/projection';
import { knownUnits } from '../tables/units';
import { placeAbout } from '../testing/written_grid';
import { scaleBar } from './scale_bar';

const box = { halfXM: 230000, halfYM: 230000, bottomM: 250, topM: 16000 };
const plane = planeOf(placeAbout([33.65, -101.81]));
const [km, miles] = knownUnits.distance as unknown as [
    (typeof knownUnits.distance)[0],
    (typeof knownUnits.distance)[0],
];
const viewOf = (more: Partial<Camera>) => new ViewGeometry(box, { ...usualCamera, ...more }, 5, 1000, 700);

test('the bar of a map is as long as its kilometers', () => {
    const geometry = viewOf({ tiltDeg: 0 });
    const bar = scaleBar(geometry, plane, km, 120)!;
    assert.equal(bar.number, 50);
    assert(Math.abs(bar.pixels * geometry.metersPerPixel - 50000) < 50);
    const ofMiles = scaleBar(geometry, plane, miles, 120)!;
    assert(Math.abs(ofMiles.pixels * geometry.metersPerPixel - ofMiles.number * miles.si) < 50);
});

test('in perspective, the bar has the scale of the ground at the center', () => {
    for (const zoom of [1, 7, 60]) {
        const geometry = viewOf({ tiltDeg: 60, fieldOfViewDeg: 40, zoom, lookAtM: [40000, -20000, 3000] });
        const bar = scaleBar(geometry, plane, km, 120)!;
        assert(bar.pixels <= 120 && bar.pixels > 40, `${bar.pixels} pixels at zoom ${zoom}`);
        const [from, to] = [-0.5, 0.5].map((side) => geometry.ground(500 + side * bar.pixels, 350)!) as [
            [number, number],
            [number, number],
        ];
        const lengthM = Math.hypot(to[0] - from[0], to[1] - from[1]);
        assert(Math.abs(lengthM / (1000 * bar.number) - 1) < 0.002, `${lengthM} m for ${bar.number} km`);
    }
});

test('the sky has no scale', () =>
    assert.equal(scaleBar(viewOf({ tiltDeg: 90, fieldOfViewDeg: 40 }), plane, km, 120), null));
