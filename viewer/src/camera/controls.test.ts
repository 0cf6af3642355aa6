import assert from 'node:assert/strict';
import test from 'node:test';

import { dragged, isMap, namedView, orbited, panned, zoomed } from './controls';
import { beamAt } from '../fields/sweep_cone';
import { Box, Camera, ViewGeometry, usualCamera } from './geometry';

const box: Box = { halfXM: 230000, halfYM: 230000, bottomM: 0, topM: 16000 };
const geometryOf = (camera: Camera) => new ViewGeometry(box, camera, 3, 800, 600);

test('the azimuth wraps around, and the tilt stops at the horizon and straight above', () => {
    let camera = usualCamera;
    for (let i = 0; i < 40; ++i) camera = orbited(camera, 100, -100);
    assert(camera.azimuthDeg >= 0 && camera.azimuthDeg < 360);
    assert.equal(camera.tiltDeg, 90);
    for (let i = 0; i < 40; ++i) camera = orbited(camera, 0, 100);
    assert.equal(camera.tiltDeg, 0);
});

test('zooming keeps the place under the pointer', () => {
    for (const camera of [usualCamera, { ...usualCamera, tiltDeg: 0 }, { ...usualCamera, azimuthDeg: 30, zoom: 4 }]) {
        const before = geometryOf(camera);
        const place = before.ground(620, 410)!;
        const after = geometryOf(zoomed(camera, before, 1.7, 620, 410));
        const pixel = after.project([place[0], place[1], 0])!;
        assert(Math.hypot(pixel[0] - 620, pixel[1] - 410) < 0.5, pixel.join(' '));
    }
});

test('zooming is bounded', () => {
    let camera = usualCamera;
    for (let i = 0; i < 100; ++i) camera = zoomed(camera, geometryOf(camera), 2);
    const most = camera.zoom;
    assert(most <= 1000, 'stormcellar frame takes zooms up to 1000');
    for (let i = 0; i < 100; ++i) camera = zoomed(camera, geometryOf(camera), 0.5);
    assert(camera.zoom >= 0.01 && camera.zoom < most);
});

test('moving keeps the same place under the pointer', () => {
    for (const camera of [
        { ...usualCamera, tiltDeg: 0 },
        { ...usualCamera, azimuthDeg: 120 },
    ]) {
        const before = geometryOf(camera);
        const place = before.ground(400, 300)!;
        const after = geometryOf(panned(camera, before, 60, -40));
        const pixel = after.project([place[0], place[1], 0])!;
        assert(Math.hypot(pixel[0] - 460, pixel[1] - 260) < 1, pixel.join(' '));
    }
});

test('a named view sets the direction of the camera, and keeps the rest', () => {
    const camera: Camera = { ...usualCamera, zoom: 7, lookAtM: [1, 2, 3] };
    assert.deepEqual([namedView(camera, 'top').tiltDeg, namedView(camera, 'east').azimuthDeg], [0, 90]);
    assert.equal(namedView(camera, 'south').zoom, 7);
    assert.deepEqual(namedView(camera, 'south').lookAtM, [1, 2, 3]);
});

test('Top is a map: echo aloft is drawn over its place, with north up (2026-11-28: a sweep was 4.1 km off at 184 km)', () => {
    const seen: Camera = { ...usualCamera, fieldOfViewDeg: 40, azimuthDeg: 75, tiltDeg: 60, zoom: 1.5 };
    const map = namedView(seen, 'top');
    assert.equal(isMap(map), true);
    const geometry = geometryOf(map);
    const site = { latitudeDeg: 35.3, altitudeM: 400 };
    for (const azimuth of [0, 0.7, 2, 4]) {
        const { arcM, heightM } = beamAt(site, 0.5, 184000);
        const [x, y] = [arcM * Math.sin(azimuth), arcM * Math.cos(azimuth)];
        const aloft = geometry.project([x, y, heightM * geometry.exaggeration])!;
        const ground = geometry.project([x, y, 0])!;
        assert(Math.hypot(aloft[0] - ground[0], aloft[1] - ground[1]) * geometry.metersPerPixel < 1, `${azimuth}`);
    }
    const [south, north] = [-100000, 100000].map((y) => geometry.project([0, y, 0])!);
    assert(north![1] < south![1] && Math.abs(north![0] - south![0]) < 1e-6);
});

test('a drag moves a map and turns other views; a drag with Shift does the opposite (2026-11-28: a drag turned the map by 122°)', () => {
    const map = namedView({ ...usualCamera, fieldOfViewDeg: 40 }, 'top');
    const moved = dragged(map, geometryOf(map), [60, -40], 2, false);
    assert.deepEqual([moved.azimuthDeg, moved.tiltDeg], [180, 0]);
    assert.deepEqual(moved, panned(map, geometryOf(map), 120, -80));
    const turned = dragged(map, geometryOf(map), [60, -40], 2, true);
    assert.deepEqual(turned, orbited(map, 60, -40));
    assert.deepEqual(dragged(turned, geometryOf(turned), [10, 0], 2, false), orbited(turned, 10, 0));
    assert.equal(namedView(map, 'oblique').fieldOfViewDeg, 40, 'other views have perspective again');
});
