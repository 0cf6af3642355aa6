import assert from 'node:assert/strict';
import test from 'node:test';

import { ViewGeometry, usualCamera } from '../camera/geometry';
import { planeOf } from '../earth/projection';
import { projections } from '../facts';
import { lightnessOf, pathOf, seenLines } from './shape_path';

const planeAt = (latitude: number, longitude: number) =>
    planeOf({
        projection: projections.azimuthal_equidistant.number,
        nx: 100,
        ny: 100,
        centerDeg: [latitude, longitude],
        spacing: 1000,
        parallelsDeg: [0, 0],
        offsetCells: [0, 0],
    });
const box = { halfXM: 50_000, halfYM: 50_000, bottomM: 0, topM: 20_000 };
const at = (latitudeDeg: number, longitudeDeg: number) => ({ latitudeDeg, longitudeDeg });

test('an edge is straight in latitude and longitude', () => {
    const path = pathOf([at(40, -100), at(40, -96)], planeAt(40, -98), 1000);
    assert.equal(path.length, 2 * 17, 'parts of a quarter of a degree');
    // The middle of the parallel is south of the straight line between its ends.
    assert.ok(path[1]! > 1500, `${path[1]}`);
    assert.ok(Math.abs(path[17]!) < 1, `the middle is on the parallel: ${path[17]}`);
});

test('an edge takes the short way around the date line', () => {
    const path = pathOf([at(10, 179.9), at(10, -179.9)], planeAt(10, 180), 1000);
    assert.ok(
        path.every((one) => Math.abs(one) < 12_000),
        String(path),
    );
});

test('a line of long edges has few parts', () => {
    const places = Array.from({ length: 4000 }, (_, i) => at(i % 2 === 0 ? -80 : 80, 0));
    const plane = { toPlane: () => [0, 0] as [number, number], toPlace: () => at(0, 0) };
    assert.ok(pathOf(places, plane, 10_000).length / 2 < 15_000);
});

test('a line from above is at its places', () => {
    const geometry = new ViewGeometry(box, { ...usualCamera, azimuthDeg: 180, tiltDeg: 0 }, 1, 400, 400);
    const perPixel = geometry.metersPerPixel;
    const lines = seenLines(Float64Array.of(0, 0, 10_000, 20_000), geometry, 2);
    assert.equal(lines.length, 1);
    const [from, to] = lines[0]!;
    assert.deepEqual(from, [100, 100]);
    assert.ok(Math.abs(to![0] - (200 + 10_000 / perPixel) / 2) < 1e-9);
    assert.ok(Math.abs(to![1] - (200 - 20_000 / perPixel) / 2) < 1e-9);
    assert.deepEqual(seenLines(Float64Array.of(9e5, 0, 9e5, 1e5), geometry, 2), [], 'beside the picture');
    assert.equal(seenLines(Float64Array.of(0, 0, 1e4, 0, NaN, NaN, 2e4, 0, 3e4, 0), geometry, 1).length, 2);
});

test('points of a line are left out if they are in the same pixel', () => {
    const geometry = new ViewGeometry(box, { ...usualCamera, azimuthDeg: 180, tiltDeg: 0 }, 1, 400, 400);
    const path = Float64Array.from({ length: 2002 }, (_, i) => (i % 2 === 0 ? 5 * i : 0)); // 10 m apart
    const [line] = seenLines(path, geometry, 1);
    assert.ok(line!.length < 150, `${line!.length} points`);
    assert.deepEqual(line!.pop(), geometry.project([10_000, 0, 0]));
});

test('a line that passes the camera ends at the camera', () => {
    const camera = { ...usualCamera, azimuthDeg: 180, tiltDeg: 80, fieldOfViewDeg: 60, zoom: 1 };
    const geometry = new ViewGeometry(box, camera, 1, 400, 400);
    const behind = geometry.eye[1] - 300_000;
    assert.equal(geometry.project([0, behind, 0]), null);
    const lines = seenLines(Float64Array.of(0, behind, 0, 0), geometry, 1);
    assert.equal(lines.length, 1);
    const [from, to] = lines[0]!;
    assert.ok(from![1] > 400, 'it leaves the picture at the bottom');
    assert.deepEqual(to, geometry.project([0, 0, 0]));
});

test('lightness is that of CIELAB', () => {
    assert.ok(Math.abs(lightnessOf([255, 255, 255]) - 100) < 1e-9);
    assert.ok(Math.abs(lightnessOf([119, 119, 119]) - 50.03) < 0.01);
    assert.ok(Math.abs(lightnessOf([139, 0, 0]) - 28.1) < 0.1);
});
