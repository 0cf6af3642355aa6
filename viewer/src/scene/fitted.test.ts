import assert from 'node:assert/strict';
import test from 'node:test';

import { Box, Vec3, ViewGeometry } from '../camera/geometry';
import { FittedView } from '../wire/api';
import { cameraOfFitted } from './fitted';

const box: Box = { halfXM: 230000, halfYM: 230000, bottomM: 0, topM: 16000 };
const fitted: FittedView = {
    camera: { azimuth_deg: -160, tilt_deg: 60, field_of_view_deg: 60, place_m: [60000, -90000, 25000] },
    focus_m: [20000, 30000, 4000],
    exaggeration: 3,
    opacity: 1,
    has_echo: true,
};

// Returns the pixel at which the fitted camera, which has a place of its own, sees a point.
function seen([x, y, heightM]: Vec3, width: number, height: number): [number, number] {
    const turned = { azimuthDeg: 200, tiltDeg: 60, zoom: 1, fieldOfViewDeg: 0, lookAtM: null };
    const axes = new ViewGeometry(box, turned, fitted.exaggeration, width, height);
    const [px, py, pz] = fitted.camera.place_m!;
    const from: Vec3 = [x - px, y - py, (heightM - pz) * fitted.exaggeration];
    const along = (axis: Vec3) => from.reduce((sum, part, i) => sum + part * axis[i]!, 0);
    const focal = (0.5 * width) / Math.tan(Math.PI / 6);
    const scale = focal / along(axes.forward);
    return [0.5 * width + scale * along(axes.right), 0.5 * height - scale * along(axes.up)];
}

test('the page shows the focus and its surroundings where the fitted camera sees them', () => {
    for (const [width, height] of [
        [800, 600],
        [300, 700],
    ] as const) {
        const camera = cameraOfFitted(fitted, box, width, height);
        const view = new ViewGeometry(box, camera, fitted.exaggeration, width, height);
        const radians = Math.PI / 180;
        const right: Vec3 = [-Math.cos(200 * radians) * 10000, Math.sin(200 * radians) * 10000, 0];
        for (const aside of [-1, 0, 1]) {
            const [x, y, z] = fitted.focus_m;
            const point: Vec3 = [x + aside * right[0], y + aside * right[1], z];
            const at = view.project([point[0], point[1], point[2] * fitted.exaggeration])!;
            const [wantedX, wantedY] = seen(point, width, height);
            assert(Math.hypot(at[0] - wantedX, at[1] - wantedY) < 0.01, `${at} ${wantedX} ${wantedY}`);
        }
    }
});

test('without echo the camera sees the whole grid', () => {
    const none = { ...fitted, camera: { ...fitted.camera, place_m: null } };
    assert.deepEqual(cameraOfFitted(none, box, 800, 600), {
        azimuthDeg: 200,
        tiltDeg: 60,
        zoom: 1,
        fieldOfViewDeg: 60,
        lookAtM: null,
    });
});
