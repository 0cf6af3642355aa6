import assert from 'node:assert/strict';
import test from 'node:test';

import { Window, flown, landed, speedOf, takenOff, turned, withEye } from './fly';
import { Camera, Vec3, ViewGeometry, dot, minus, usualCamera } from './geometry';

const view: Window = {
    box: { halfXM: 230000, halfYM: 200000, bottomM: 250, topM: 16000 },
    exaggeration: 3,
    width: 796,
    height: 532,
};
const geometryOf = (camera: Camera) => new ViewGeometry(view.box, camera, view.exaggeration, view.width, view.height);
const apart = (a: Vec3, b: Vec3) => Math.hypot(...minus(a, b));
const camera: Camera = { azimuthDeg: 200, tiltDeg: 70, zoom: 1, fieldOfViewDeg: 60, lookAtM: [12000, -5000, 3000] };

test('withEye() puts the eye at the given place', () => {
    const eye: Vec3 = [-40000, 10000, 9000];
    assert.ok(apart(geometryOf(withEye(camera, view, eye)).eye, eye) < 1e-6);
});

test('turning keeps the eye and changes the direction', () => {
    const next = turned(camera, view, 30, 10);
    assert.ok(apart(geometryOf(next).eye, geometryOf(camera).eye) < 1e-6);
    assert.deepEqual([next.azimuthDeg, next.tiltDeg], [230, 80]);
    assert.equal(turned(camera, view, 0, 90).tiltDeg, 90);
});

test('moving goes along the view, and never below the ground', () => {
    const before = geometryOf(camera);
    const after = geometryOf(flown(camera, view, 1000, 0, 0));
    assert.ok(Math.abs(dot(minus(after.eye, before.eye), before.forward) - 1000) < 1e-6);
    const low = geometryOf(flown(camera, view, 0, 0, -1e7));
    assert.ok(Math.abs(low.eye[2] - (low.groundM * view.exaggeration + 200)) < 1e-6);
});

test('a flight begins with nearly the same picture', () => {
    for (const from of [
        usualCamera,
        { ...camera, zoom: 6 },
        { ...usualCamera, zoom: 4, lookAtM: [30000, 20000, 5000] as Vec3 },
    ]) {
        const off = takenOff(from, view);
        assert.ok(off.fieldOfViewDeg > 0 && off.zoom === 1);
        const [before, after] = [geometryOf(from), geometryOf(off)];
        // The point in the middle of the picture stays in the middle, and its surroundings keep their size.
        const target: Vec3 = from.lookAtM
            ? [from.lookAtM[0], from.lookAtM[1], from.lookAtM[2] * view.exaggeration]
            : before.middle;
        const pixel = after.project(target)!;
        assert.ok(Math.abs(pixel[0] - 398) < 0.01 && Math.abs(pixel[1] - 266) < 0.01);
        const aside = after.project([target[0] + 100 * before.right[0], target[1] + 100 * before.right[1], target[2]])!;
        assert.ok(Math.abs(aside[0] - pixel[0] - 100 / before.metersPerPixel) < 0.02 * (100 / before.metersPerPixel));
    }
});

test('a flight is fast high up and slow near the ground', () => {
    assert.ok(speedOf(withEye(camera, view, [0, 0, 60000]), view) > speedOf(withEye(camera, view, [0, 0, 3000]), view));
});

test('after a flight the camera looks at the ground of the grid, and the picture stays', () => {
    for (const eye of [
        [0, -50000, 40000],
        [-100000, 20000, 9000],
    ] as Vec3[]) {
        const flight = withEye({ ...camera, azimuthDeg: 180 }, view, eye);
        const down = landed(flight, view);
        const [before, after] = [geometryOf(flight), geometryOf(down)];
        const [east, north, height] = down.lookAtM!;
        assert.equal(height, before.groundM);
        const at: Vec3 = [east, north, height * view.exaggeration];
        for (const geometry of [before, after]) {
            const pixel = geometry.project(at)!;
            assert.ok(Math.abs(pixel[0] - 398) < 0.01 && Math.abs(pixel[1] - 266) < 0.01);
        }
        const aside: Vec3 = [at[0] + 100 * before.right[0], at[1] + 100 * before.right[1], at[2]];
        assert.ok(Math.abs(before.project(aside)![0] - after.project(aside)![0]) < 0.01);
    }
    const beyond = landed(withEye({ ...camera, tiltDeg: 90 }, view, [0, 900000, 5000]), view);
    assert.ok(Math.abs(beyond.lookAtM![1]) <= view.box.halfYM);
});
