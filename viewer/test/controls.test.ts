import assert from 'node:assert/strict';
import test from 'node:test';

import { namedView, orbited, panned, zoomed } from '../src/camera/controls';
import { Box, Camera, ViewGeometry, usualCamera } from '../src/camera/geometry';

const box: Box = { halfXM: 230000, halfYM: 230000, bottomM: 0, topM: 16000 };
const geometryOf = (camera: Camera) => new ViewGeometry(box, camera, 3, 800, 600);

test('turning goes round and stops at the horizon and above', () => {
    let camera = usualCamera;
    for (let i = 0; i < 40; ++i) camera = orbited(camera, 100, -100);
    assert(camera.azimuthDeg >= 0 && camera.azimuthDeg < 360);
    assert.equal(camera.tiltDeg, 90);
    for (let i = 0; i < 40; ++i) camera = orbited(camera, 0, 100);
    assert.equal(camera.tiltDeg, 0);
});

test('the place under the pointer stays there while it zooms', () => {
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

test('moving takes what was under the pointer along', () => {
    for (const camera of [{ ...usualCamera, tiltDeg: 0 }, { ...usualCamera, azimuthDeg: 120 }]) {
        const before = geometryOf(camera);
        const place = before.ground(400, 300)!;
        const after = geometryOf(panned(camera, before, 60, -40));
        const pixel = after.project([place[0], place[1], 0])!;
        assert(Math.hypot(pixel[0] - 460, pixel[1] - 260) < 1, pixel.join(' '));
    }
});

test('named views are where their names say, and keep the rest', () => {
    const camera: Camera = { ...usualCamera, zoom: 7, lookAtM: [1, 2, 3] };
    assert.deepEqual([namedView(camera, 'top').tiltDeg, namedView(camera, 'east').azimuthDeg], [0, 90]);
    assert.equal(namedView(camera, 'south').zoom, 7);
    assert.deepEqual(namedView(camera, 'south').lookAtM, [1, 2, 3]);
});
