import assert from 'node:assert/strict';
import test from 'node:test';
import { namedView, orbited, panned, zoomed } from './controls';
import { Camera, ViewGeometry, heightRange, usualCamera } from './geometry';

const box = { halfXM: 230e3, halfYM: 200e3, bottomM: 250, topM: 16250 };
const view = (camera: Partial<Camera>, width = 796, height = 532) =>
    new ViewGeometry(box, { ...usualCamera, ...camera }, 5, width, height);
const cameras: Partial<Camera>[] = [
    {},
    { tiltDeg: 0 },
    { azimuthDeg: 37, tiltDeg: 80, fieldOfViewDeg: 40 },
    { zoom: 3, lookAtM: [20e3, -50e3, 3000], fieldOfViewDeg: 60 },
];

test('the box just fits the picture at zoom 1', () => {
    for (const fieldOfViewDeg of [0, 40]) {
        const geometry = view({ fieldOfViewDeg });
        let most = 0;
        for (let i = 0; i < 8; ++i) {
            const corner = [i & 1 ? 230e3 : -230e3, i & 2 ? 200e3 : -200e3, (i & 4 ? 16250 : 0) * 5] as [
                number,
                number,
                number,
            ];
            const [x, y] = geometry.project(corner)!;
            most = Math.max(most, Math.abs(x - 398) / 398, Math.abs(y - 266) / 266);
        }
        assert(Math.abs(most - 1 / 1.04) < 1e-9, `${most}`);
    }
});

test('the ground under a pixel projects to that pixel', () => {
    for (const camera of cameras) {
        const geometry = view(camera);
        for (const [x, y] of [
            [398, 300],
            [100, 500],
            [700, 420],
        ] as const) {
            const ground = geometry.ground(x, y);
            assert(ground);
            const pixel = geometry.project([ground[0], ground[1], 0])!;
            assert(Math.hypot(pixel[0] - x, pixel[1] - y) < 1e-6);
        }
    }
});

test('from the south north is up and east is right', () => {
    const geometry = view({});
    const [x, y] = geometry.project([0, 0, 0])!;
    assert(geometry.project([1e4, 0, 0])![0] > x);
    assert(geometry.project([0, 1e4, 0])![1] < y);
    assert(geometry.project([0, 0, 1e4])![1] < y);
});

test('all of the box lies between near and far', () => {
    for (const camera of cameras) {
        const geometry = view(camera);
        assert(geometry.farM > geometry.nearM);
        const middle = geometry.point(398, 266, 0.5 * (geometry.nearM + geometry.farM));
        assert(middle.every(Number.isFinite));
    }
});

test('a zoom keeps the place under the pointer', () => {
    for (const camera of [{}, { azimuthDeg: 37, fieldOfViewDeg: 0, tiltDeg: 30 }]) {
        const before = { ...usualCamera, ...camera };
        const geometry = view(before);
        const place = geometry.ground(600, 400)!;
        const after = view(zoomed(before, geometry, 2, 600, 400));
        const pixel = after.project([place[0], place[1], 0])!;
        assert(Math.hypot(pixel[0] - 600, pixel[1] - 400) < 0.01, `${pixel}`);
    }
});

test('a drag moves the ground with the pointer, and turning stays in its bounds', () => {
    const geometry = view({});
    const place = geometry.ground(398, 266)!;
    const after = view(panned(usualCamera, geometry, 50, 30));
    const pixel = after.project([place[0], place[1], 0])!;
    assert(Math.abs(pixel[0] - 448) < 0.01 && Math.abs(pixel[1] - 296) < 0.01, `${pixel}`);
    assert.equal(orbited(usualCamera, 0, -1e4).tiltDeg, 90);
    assert.equal(orbited(usualCamera, 0, 1e4).tiltDeg, 0);
    const turned = orbited({ ...usualCamera, azimuthDeg: 359 }, 10, 0).azimuthDeg;
    assert(turned >= 0 && turned < 360);
    assert.equal(namedView(usualCamera, 'top').tiltDeg, 0);
});

test('cells reach half a level beyond the outermost levels', () => {
    assert.deepEqual(heightRange([500, 1000, 2000]), { bottomM: 250, topM: 2500 });
    assert.deepEqual(heightRange([3000]), { bottomM: 2500, topM: 3500 });
});
