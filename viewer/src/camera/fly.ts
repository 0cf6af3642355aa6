// Moves and turns the eye of the camera in a flight. A camera does not store its eye, so these functions move the point
// that the camera looks at until the eye is at the wanted place.

import { ranges } from '../facts';
import { Box, Camera, Vec3, ViewGeometry, dot, minus, plus } from './geometry';

export interface Window {
    box: Box;
    exaggeration: number;
    width: number; // pixels
    height: number;
}

const geometryOf = (camera: Camera, { box, exaggeration, width, height }: Window): ViewGeometry =>
    new ViewGeometry(box, camera, exaggeration, width, height);

// Returns the camera with its eye moved to a place in drawn space. The direction of the view stays.
export function withEye(camera: Camera, window: Window, eye: Vec3): Camera {
    const usual = geometryOf({ ...camera, lookAtM: null }, window);
    const drawn = plus(minus(eye, usual.eye), 1, usual.middle);
    return { ...camera, lookAtM: [drawn[0], drawn[1], drawn[2] / window.exaggeration] };
}

const flownFieldDeg = 60;

// Returns the camera that begins a flight. It has perspective, and shows nearly the same picture as before.
export function takenOff(camera: Camera, window: Window): Camera {
    const now = geometryOf(camera, window);
    const lookAt = camera.lookAtM;
    const target: Vec3 = lookAt ? [lookAt[0], lookAt[1], lookAt[2] * window.exaggeration] : now.middle;
    // Across the target, the picture shows the same width in meters as before.
    const across = now.metersPerPixel * window.width;
    const back = across / 2 / Math.tan((flownFieldDeg * Math.PI) / 360);
    return withEye({ ...camera, fieldOfViewDeg: flownFieldDeg, zoom: 1 }, window, plus(target, -back, now.forward));
}

// Returns the camera that ends a flight. It looks at the ground in the middle of the picture, or at the edge of the
// grid if that place is beyond. So the view then turns about a place of the grid. The place keeps its size.
export function landed(camera: Camera, window: Window): Camera {
    const now = geometryOf(camera, window);
    const { halfXM, halfYM } = window.box;
    const down = Math.max(1e-3, -now.forward[2]);
    const way = Math.min(now.farM, (now.eye[2] - now.groundM * window.exaggeration) / down);
    const seen = plus(now.eye, way, now.forward);
    const clamped = (value: number, most: number) => Math.min(most, Math.max(-most, value));
    const at: Vec3 = [clamped(seen[0], halfXM), clamped(seen[1], halfYM), now.groundM * window.exaggeration];
    const depthM = Math.max(1000, dot(minus(at, now.eye), now.forward));
    const usualDepthM = now.metersPerPixel * now.focalPixels; // of the point at which the camera looks
    const zoom = (camera.zoom * usualDepthM) / depthM;
    return {
        ...camera,
        zoom: Math.min(ranges.zoom.most, Math.max(ranges.zoom.least, zoom)),
        lookAtM: [at[0], at[1], now.groundM],
    };
}

// Turns the camera about its eye, by degrees.
export function turned(camera: Camera, window: Window, rightDeg: number, upDeg: number): Camera {
    const { eye } = geometryOf(camera, window);
    const azimuth = camera.azimuthDeg + rightDeg;
    const next: Camera = {
        ...camera,
        azimuthDeg: ((azimuth % 360) + 360) % 360,
        tiltDeg: Math.min(ranges.tiltDeg.most, Math.max(ranges.tiltDeg.least, camera.tiltDeg + upDeg)),
    };
    return withEye(next, window, eye);
}

// Moves the eye by drawn meters ahead, to the right and upward. Keeps it at least 200 drawn meters above the ground.
export function flown(camera: Camera, window: Window, aheadM: number, rightM: number, upM: number): Camera {
    const now = geometryOf(camera, window);
    const eye = plus(plus(now.eye, aheadM, now.forward), rightM, now.right);
    const ground = now.groundM * window.exaggeration;
    return withEye(camera, window, [eye[0], eye[1], Math.max(ground + 200, eye[2] + upM)]);
}

// Returns the speed of a flight in drawn meters a second. It is lower near the ground.
export function speedOf(camera: Camera, window: Window): number {
    const { eye, groundM } = geometryOf(camera, window);
    return Math.min(200_000, Math.max(4_000, 0.6 * (eye[2] - groundM * window.exaggeration)));
}
