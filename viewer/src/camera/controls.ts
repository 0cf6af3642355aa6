// Applies mouse, keys and fingers to a camera. Each function returns a new camera.

import { ranges } from '../facts';
import { Camera, Vec3, ViewGeometry, plus } from './geometry';

const degreesAPixel = 0.35;
const leastZoom = 0.2;
const mostZoom = 200;
export const usualFieldOfViewDeg = 40;

function bounded(value: number, least: number, most: number): number {
    return Math.min(most, Math.max(least, value));
}

export function orbited(camera: Camera, dx: number, dy: number): Camera {
    const azimuth = camera.azimuthDeg + dx * degreesAPixel;
    return {
        ...camera,
        azimuthDeg: ((azimuth % 360) + 360) % 360,
        tiltDeg: bounded(camera.tiltDeg - dy * degreesAPixel, ranges.tiltDeg.least, ranges.tiltDeg.most),
    };
}

// Returns the point that the camera looks at; the middle of the box if none was set.
export function lookAtOf(camera: Camera, geometry: ViewGeometry): Vec3 {
    return camera.lookAtM ?? [geometry.middle[0], geometry.middle[1], geometry.middle[2] / geometry.exaggeration];
}

// Moves the scene along the ground with the pointer.
export function panned(camera: Camera, geometry: ViewGeometry, dx: number, dy: number): Camera {
    const at = lookAtOf(camera, geometry);
    const scale = geometry.metersPerPixel;
    // A drag up or down moves the scene along the view's direction on the ground. A pixel of the drag is more meters if
    // the view is nearer to horizontal: up to five times the meters of a view from above.
    const ahead: Vec3 = [
        -Math.sin((camera.azimuthDeg * Math.PI) / 180),
        -Math.cos((camera.azimuthDeg * Math.PI) / 180),
        0,
    ];
    const foreshortened = Math.max(0.2, Math.cos((camera.tiltDeg * Math.PI) / 180));
    return { ...camera, lookAtM: plus(plus(at, -dx * scale, geometry.right), (dy * scale) / foreshortened, ahead) };
}

// Returns true if the camera looks straight down without perspective. Echo at any height is then drawn over its place
// on the ground.
export function isMap(camera: Camera): boolean {
    return camera.tiltDeg === 0 && camera.fieldOfViewDeg === 0;
}

// Applies a drag. `isOther` is true for a drag with Shift or the right button. A plain drag moves a map and turns any
// view that is not a map; a drag with `isOther` does the opposite.
export function dragged(
    camera: Camera,
    geometry: ViewGeometry,
    [dx, dy]: readonly [number, number],
    ratio: number,
    isOther: boolean,
): Camera {
    return isMap(camera) !== isOther ? panned(camera, geometry, dx * ratio, dy * ratio) : orbited(camera, dx, dy);
}

export function zoomed(camera: Camera, geometry: ViewGeometry, factor: number, x?: number, y?: number): Camera {
    const zoom = bounded(camera.zoom * factor, leastZoom, mostZoom);
    const at = lookAtOf(camera, geometry);
    const under = x === undefined || y === undefined ? null : geometry.ground(x, y);
    const center = geometry.ground(geometry.width / 2, geometry.height / 2);
    if (!under || !center) return { ...camera, zoom };
    // Keep the place under the pointer.
    const share = 1 - camera.zoom / zoom;
    return {
        ...camera,
        zoom,
        lookAtM: [at[0] + share * (under[0] - center[0]), at[1] + share * (under[1] - center[1]), at[2]],
    };
}

export type NamedView = 'top' | 'south' | 'east' | 'north' | 'west' | 'oblique';
// Turns the camera to a named view. The view from the top is a map with north up; other views that a user opens from a
// map have perspective.
export function namedView(camera: Camera, view: NamedView): Camera {
    const [azimuthDeg, tiltDeg] = {
        top: [180, 0],
        south: [180, 85],
        east: [90, 85],
        north: [0, 85],
        west: [270, 85],
        oblique: [180, 55],
    }[view] as [number, number];
    const fieldOfViewDeg = view === 'top' ? 0 : isMap(camera) ? usualFieldOfViewDeg : camera.fieldOfViewDeg;
    return { ...camera, azimuthDeg, tiltDeg, fieldOfViewDeg };
}
