// Projects shapes onto the plane of a grid and into the picture (render/map/shape_marks.h). Edges are straight in
// latitude and longitude, as RFC 7946 has it, and go the short way around the date line.

import { Vec3, ViewGeometry } from '../camera/geometry';
import { GridPlane, Place } from '../earth/projection';

export type Pixel = [number, number];

// Edges are split into parts of at most this length, because they are not straight on the map.
const longestPartDeg = 0.25;
const leastPixels = 0.3;
// In perspective, lines end this close to the camera, as a share of its height above the ground.
const nearShare = 0.01;

const eastDeg = (from: Place, to: Place): number => {
    const degrees = to.longitudeDeg - from.longitudeDeg;
    return degrees - 360 * Math.round(degrees / 360);
};
const lengthDeg = (from: Place, to: Place): number =>
    Math.max(Math.abs(to.latitudeDeg - from.latitudeDeg), Math.abs(eastDeg(from, to)));

// Returns x and y of the points of a line on the plane; NaN for a point that the projection cannot show. If the edges
// would have more than about `mostParts` parts, the parts are longer.
export function pathOf(places: readonly Place[], plane: GridPlane, mostParts: number): Float64Array {
    const all = places.slice(1).reduce((sum, place, i) => sum + lengthDeg(places[i]!, place), 0);
    const partDeg = Math.max(longestPartDeg, all / mostParts);
    const points: number[] = [];
    const add = (place: Place): void => {
        points.push(...(plane.toPlane(place) ?? [NaN, NaN]));
    };
    add(places[0]!);
    for (let i = 1; i < places.length; ++i) {
        const [from, to] = [places[i - 1]!, places[i]!];
        const parts = Math.max(1, Math.ceil(lengthDeg(from, to) / partDeg));
        for (let part = 1; part <= parts; ++part) {
            const share = part / parts;
            add({
                latitudeDeg: from.latitudeDeg + share * (to.latitudeDeg - from.latitudeDeg),
                longitudeDeg: from.longitudeDeg + share * eastDeg(from, to),
            });
        }
    }
    return Float64Array.from(points);
}

// Maps the ground of the picture to pixels: a point x, y is `depth` ahead of the camera, and `right` and `up` of its
// axis, in meters.
function groundAxes({ eye, right, up, forward, groundM, exaggeration }: ViewGeometry) {
    const along = ([x, y, z]: Vec3) => {
        const offset = (groundM * exaggeration - eye[2]) * z - eye[0] * x - eye[1] * y;
        return (atX: number, atY: number) => atX * x + atY * y + offset;
    };
    return { right: along(right), up: along(up), depth: along(forward) };
}

// Returns the parts of a path on the ground that the camera sees, in pixels of the pen. A pixel of the pen is `ratio`
// pixels of the picture wide. Leaves out a path that is wholly beside the picture, and points that are less than
// `leastPixels` from the point before.
export function seenLines(path: Float64Array, geometry: ViewGeometry, ratio: number): Pixel[][] {
    const { width, height, focalPixels, metersPerPixel, isPerspective } = geometry;
    const axes = groundAxes(geometry);
    const heightM = Math.abs(geometry.eye[2] - geometry.groundM * geometry.exaggeration);
    const near = isPerspective ? Math.max(1, nearShare * heightM) : -Infinity;
    const lines: Pixel[][] = [];
    let line: Pixel[] = [];
    let [lowX, lowY, highX, highY] = [Infinity, Infinity, -Infinity, -Infinity];
    const add = (x: number, y: number, depth: number, isEnd: boolean): void => {
        const scale = (isPerspective ? focalPixels / depth : 1 / metersPerPixel) / ratio;
        const [left, top] = [
            (0.5 * width) / ratio + axes.right(x, y) * scale,
            (0.5 * height) / ratio - axes.up(x, y) * scale,
        ];
        const last = line[line.length - 1];
        if (last && !isEnd && Math.abs(left - last[0]) < leastPixels && Math.abs(top - last[1]) < leastPixels) return;
        line.push([left, top]);
        [lowX, lowY] = [Math.min(lowX, left), Math.min(lowY, top)];
        [highX, highY] = [Math.max(highX, left), Math.max(highY, top)];
    };
    const end = (): void => {
        if (line.length > 1) lines.push(line);
        line = [];
    };
    let [beforeX, beforeY, before] = [NaN, NaN, NaN]; // the point before, and its depth; NaN: none
    for (let i = 0; i + 1 < path.length; i += 2) {
        const [x, y] = [path[i]!, path[i + 1]!];
        const depth = axes.depth(x, y);
        if (depth >= near !== before >= near && !Number.isNaN(depth + before)) {
            const share = (near - before) / (depth - before);
            add(beforeX + share * (x - beforeX), beforeY + share * (y - beforeY), near, true);
        }
        if (depth >= near) add(x, y, depth, i + 2 === path.length);
        else end();
        [beforeX, beforeY, before] = [x, y, depth];
    }
    end();
    const isSeen = highX >= 0 && highY >= 0 && lowX <= width / ratio && lowY <= height / ratio;
    return isSeen ? lines : [];
}

// Returns the lightness L* of CIELAB of a color, from 0 to 100.
export function lightnessOf(color: readonly number[]): number {
    const [red, green, blue] = [0, 1, 2].map((i) => {
        const level = (color[i] ?? 0) / 255;
        return level <= 0.04045 ? level / 12.92 : ((level + 0.055) / 1.055) ** 2.4;
    }) as [number, number, number];
    const y = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    return y > 216 / 24389 ? 116 * Math.cbrt(y) - 16 : (24389 / 27) * y;
}
