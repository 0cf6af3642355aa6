import assert from 'node:assert/strict';
import test from 'node:test';

import { Box, Camera, Vec3, ViewGeometry, heightRange, usualCamera } from './geometry';

const box: Box = { halfXM: 230000, halfYM: 200000, bottomM: 250, topM: 16000 };
const near = (a: number, b: number, most = 1e-6): boolean => Math.abs(a - b) <= most;

const cameras: Camera[] = [
    usualCamera,
    { ...usualCamera, azimuthDeg: 37, tiltDeg: 71, zoom: 3 },
    { ...usualCamera, fieldOfViewDeg: 40 },
    { azimuthDeg: 250, tiltDeg: 85, zoom: 2.5, fieldOfViewDeg: 60, lookAtM: [12000, -50000, 4000] },
    { ...usualCamera, tiltDeg: 0 },
];

test('a point that a ray passes through is drawn at the pixel of the ray', () => {
    for (const camera of cameras) {
        const geometry = new ViewGeometry(box, camera, 3, 796, 532);
        for (const [x, y] of [
            [0.5, 0.5],
            [398, 266],
            [700.25, 31],
        ] as const) {
            for (const depth of [geometry.nearM, (geometry.nearM + geometry.farM) / 2, geometry.farM]) {
                const pixel = geometry.project(geometry.point(x, y, depth))!;
                assert(near(pixel[0], x, 1e-6) && near(pixel[1], y, 1e-6), `${JSON.stringify(camera)} ${pixel}`);
            }
        }
    }
});

test('from the south, east is right and north is up', () => {
    const geometry = new ViewGeometry(box, usualCamera, 1, 800, 600);
    const middle = geometry.project([0, 0, 0])!;
    assert(geometry.project([1000, 0, 0])![0] > middle[0]);
    assert(geometry.project([0, 1000, 0])![1] < middle[1]);
    assert(geometry.project([0, 0, 1000])![1] < middle[1]);
});

test('at zoom 1 the box just fits if the camera is outside of it', () => {
    for (const camera of cameras.filter((one) => one.zoom === 1)) {
        const geometry = new ViewGeometry(box, camera, 5, 796, 532);
        let [across, down] = [0, 0];
        for (let i = 0; i < 8; ++i) {
            const corner: Vec3 = [
                i & 1 ? box.halfXM : -box.halfXM,
                i & 2 ? box.halfYM : -box.halfYM,
                i & 4 ? box.topM * 5 : 0,
            ];
            const pixel = geometry.project(corner)!;
            across = Math.max(across, Math.abs(pixel[0] - 398) / 398);
            down = Math.max(down, Math.abs(pixel[1] - 266) / 266);
        }
        assert(near(Math.max(across, down), 1 / 1.04, 1e-9), JSON.stringify(camera));
    }
});

test('the box lies between the near and the far depth', () => {
    for (const camera of cameras) {
        const geometry = new ViewGeometry(box, camera, 5, 796, 532);
        assert(geometry.nearM < geometry.farM);
        if (camera.fieldOfViewDeg > 0) assert(geometry.nearM > 0);
    }
});

test('the ground under a pixel projects back to that pixel, and a pixel of the sky has no ground', () => {
    const low = { ...usualCamera, tiltDeg: 88, fieldOfViewDeg: 60 };
    for (const camera of [...cameras, low]) {
        const geometry = new ViewGeometry(box, camera, 3, 400, 300);
        const ground = geometry.ground(200, 290)!;
        const pixel = geometry.project([...ground, geometry.groundM * 3])!;
        assert(near(pixel[0], 200) && near(pixel[1], 290));
    }
    assert.equal(new ViewGeometry(box, low, 3, 400, 300).ground(200, 1), null);
});

test('another point to look at comes to the middle and keeps the scale', () => {
    const camera: Camera = { ...usualCamera, lookAtM: [40000, 20000, 3000] };
    const geometry = new ViewGeometry(box, camera, 3, 400, 300);
    const pixel = geometry.project([40000, 20000, 9000])!;
    assert(near(pixel[0], 200) && near(pixel[1], 150));
    assert.equal(geometry.metersPerPixel, new ViewGeometry(box, usualCamera, 3, 400, 300).metersPerPixel);
});

test('cells reach half a level beyond the first and the last level', () => {
    assert.deepEqual(heightRange([500, 1000, 2000]), { bottomM: 250, topM: 2500 });
    assert.deepEqual(heightRange([3000]), { bottomM: 2500, topM: 3500 });
});

test('the shown depths hold every visible place of the box, and not much more', () => {
    const box: Box = { halfXM: 2e6, halfYM: 1e6, bottomM: 500, topM: 19000 };
    for (const camera of [
        {
            ...usualCamera,
            tiltDeg: 60,
            fieldOfViewDeg: 40,
            zoom: 16,
            lookAtM: [3e5, 1e5, 5000] as [number, number, number],
        },
        { ...usualCamera, tiltDeg: 20, fieldOfViewDeg: 0, zoom: 8, lookAtM: [0, 0, 5000] as [number, number, number] },
        { ...usualCamera, tiltDeg: 88, fieldOfViewDeg: 40, zoom: 2, lookAtM: null },
    ]) {
        const geometry = new ViewGeometry(box, camera, 5, 300, 200);
        const [near, far] = geometry.shownDepths;
        for (let x = -2e6; x <= 2e6; x += 1e5)
            for (let y = -1e6; y <= 1e6; y += 1e5)
                for (const z of [box.bottomM, box.topM]) {
                    const place: Vec3 = [x, y, z * 5];
                    const pixel = geometry.project(place);
                    if (!pixel || pixel[0] < 0 || pixel[1] < 0 || pixel[0] > 300 || pixel[1] > 200) continue;
                    const depth = geometry.depthOf(place);
                    assert(
                        depth < geometry.nearM || (depth >= near - 1 && depth <= far + 1),
                        `${depth} in ${near} to ${far}`,
                    );
                }
        if (camera.zoom === 16) assert(far - near < 0.4 * (geometry.farM - geometry.nearM));
    }
});

test('only a parallel view from straight above is a map', () => {
    const box = { halfXM: 1e5, halfYM: 1e5, bottomM: 0, topM: 1e4 };
    const isMap = (tiltDeg: number, fieldOfViewDeg: number) =>
        new ViewGeometry(box, { ...usualCamera, tiltDeg, fieldOfViewDeg }, 3, 400, 300).isMap;
    assert(isMap(0, 0));
    assert(!isMap(1, 0));
    assert(!isMap(0, 40));
});
