// Converts between places, points and pixels of the start map, which is in Web Mercator like its tiles.
//
// A point of the map is [x, y]; the earth is a square with x from 0 at 180 degrees west to 1 at 180 degrees east, and y
// from 0 in the north to 1 in the south. Longitudes repeat, so x + 1 is the same place. Pixel (0, 0) is the top left
// corner.

import { Place } from '../earth/projection';

export type MapPoint = [number, number];

export interface MapView {
    center: MapPoint;
    scale: number; // width of the whole earth in pixels
    width: number; // pixels
    height: number;
}

export interface MapBox {
    west: number; // degrees; east is greater, and may be beyond 180
    south: number;
    east: number;
    north: number;
}

const radians = Math.PI / 180;
const mostLatitudeDeg = 85.05;
const leastScale = 256;
const mostScale = 256 * 2 ** 13;
const tileSide = 256;
const equatorM = 40_075_017; // around the earth
const deepestZoom = 10;

export function mapPoint(place: Place): MapPoint {
    const latitude = Math.min(mostLatitudeDeg, Math.max(-mostLatitudeDeg, place.latitudeDeg));
    return [
        (place.longitudeDeg + 180) / 360,
        0.5 - Math.log(Math.tan(Math.PI / 4 + (latitude * radians) / 2)) / (2 * Math.PI),
    ];
}

export function placeOfPoint([x, y]: MapPoint): Place {
    const latitudeDeg = (2 * Math.atan(Math.exp((0.5 - y) * 2 * Math.PI)) - Math.PI / 2) / radians;
    return { latitudeDeg, longitudeDeg: ((((x % 1) + 1) % 1) * 360 || 0) - 180 };
}

// Returns the copy of `point` nearest to `to`, across the antimeridian too.
export function nearestCopy(point: MapPoint, to: MapPoint): MapPoint {
    return [point[0] + Math.round(to[0] - point[0]), point[1]];
}

export function pixelOf(view: MapView, point: MapPoint): [number, number] {
    const [x, y] = nearestCopy(point, view.center);
    return [(x - view.center[0]) * view.scale + view.width / 2, (y - view.center[1]) * view.scale + view.height / 2];
}

export function pointAt(view: MapView, x: number, y: number): MapPoint {
    return [view.center[0] + (x - view.width / 2) / view.scale, view.center[1] + (y - view.height / 2) / view.scale];
}

function held(view: MapView): MapView {
    const scale = Math.min(mostScale, Math.max(leastScale, view.scale));
    return { ...view, scale, center: [view.center[0], Math.min(1, Math.max(0, view.center[1]))] };
}

export function draggedMap(view: MapView, dx: number, dy: number): MapView {
    return held({ ...view, center: [view.center[0] - dx / view.scale, view.center[1] - dy / view.scale] });
}

// Scales a view. The point under the pixel (x, y) stays there, unless that would drag the map out of sight.
export function scaledMap(view: MapView, factor: number, x = view.width / 2, y = view.height / 2): MapView {
    const fixed = pointAt(view, x, y);
    const next = held({ ...view, scale: view.scale * factor });
    const now = pointAt(next, x, y);
    return held({ ...next, center: [next.center[0] + fixed[0] - now[0], next.center[1] + fixed[1] - now[1]] });
}

// Returns the x, from 0 to 1, of the first point east of the widest gap between the points.
function westernmost(points: MapPoint[]): number {
    const xs = points.map(([x]) => ((x % 1) + 1) % 1).sort((a, b) => a - b);
    let widest = xs[0]! + 1 - xs[xs.length - 1]!;
    let first = xs[0]!;
    for (let i = 1; i < xs.length; ++i) {
        const gap = xs[i]! - xs[i - 1]!;
        if (gap > widest) {
            widest = gap;
            first = xs[i]!;
        }
    }
    return first;
}

// Returns a view of all points, or of the whole earth without points. `clear` has the numbers of pixels that the page
// covers at the left, top, right and bottom.
export function fittedMap(
    points: MapPoint[],
    width: number,
    height: number,
    clear: [number, number, number, number],
    mostAcross = mostScale,
): MapView {
    const [left, top, right, bottom] = clear;
    const whole: MapView = { center: [0.5, 0.4], scale: width, width, height };
    if (points.length === 0) return held(whole);
    const first = westernmost(points) - 1e-9;
    const xs = points.map(([x]) => first + ((((x - first) % 1) + 1) % 1));
    const ys = points.map(([, y]) => y);
    const [west, east] = [Math.min(...xs), Math.max(...xs)];
    const [north, south] = [Math.min(...ys), Math.max(...ys)];
    const room = [Math.max(32, width - left - right), Math.max(32, height - top - bottom)] as const;
    const scale = Math.min(room[0] / Math.max(1e-9, east - west), room[1] / Math.max(1e-9, south - north), mostAcross);
    const view = held({ center: [(west + east) / 2, (north + south) / 2], scale, width, height });
    return held({
        ...view,
        center: [view.center[0] + (right - left) / 2 / view.scale, view.center[1] + (bottom - top) / 2 / view.scale],
    });
}

export interface Tile {
    zoom: number;
    column: number;
    row: number;
    x: number; // of its top left corner, in pixels of the view
    y: number;
    side: number;
}

// Returns the tiles that the view shows, at the zoom whose pixels are nearest in size to the pixels of the view.
export function tilesOf(view: MapView): Tile[] {
    const zoom = Math.min(deepestZoom, Math.max(0, Math.round(Math.log2(view.scale / tileSide))));
    const count = 2 ** zoom;
    const side = view.scale / count;
    const [west, north] = pointAt(view, 0, 0);
    const [east, south] = pointAt(view, view.width, view.height);
    const tiles: Tile[] = [];
    for (let row = Math.max(0, Math.floor(north * count)); row < Math.min(count, south * count); ++row) {
        for (let i = Math.floor(west * count); i < east * count; ++i) {
            const [x, y] = [(i / count - west) * view.scale, (row / count - north) * view.scale];
            tiles.push({ zoom, column: ((i % count) + count) % count, row, x, y, side });
        }
    }
    return tiles;
}

// Returns the box with corners at two pixels of a view.
export function boxBetween(view: MapView, a: [number, number], b: [number, number]): MapBox {
    const [west, north] = pointAt(view, Math.min(a[0], b[0]), Math.min(a[1], b[1]));
    const [east, south] = pointAt(view, Math.max(a[0], b[0]), Math.max(a[1], b[1]));
    const westDeg = placeOfPoint([west, 0.5]).longitudeDeg;
    return {
        west: westDeg,
        east: westDeg + (east - west) * 360,
        south: placeOfPoint([0, south]).latitudeDeg,
        north: placeOfPoint([0, north]).latitudeDeg,
    };
}

const turned = (degrees: number): number => ((degrees % 360) + 360) % 360;

// Returns the smallest box that holds all places. The longitudes of its sides are within 180 degrees of `middleDeg`.
export function boxAbout(middleDeg: number, places: Place[]): MapBox {
    const longitudes = places.map((place) => middleDeg - 180 + turned(place.longitudeDeg - middleDeg + 180));
    const latitudes = places.map((place) => place.latitudeDeg);
    return {
        west: Math.min(...longitudes),
        south: Math.min(...latitudes),
        east: Math.max(...longitudes),
        north: Math.max(...latitudes),
    };
}

// Returns a box with a margin at each side. The margin is a share of the side's length. The box gets no wider than the
// earth, and reaches no farther than 85 degrees north and south.
export function grownBox({ west, south, east, north }: MapBox, share: number): MapBox {
    const wide = Math.min(360, east - west);
    const dx = Math.min(share * wide, (360 - wide) / 2);
    const dy = share * (north - south);
    return {
        west: west - dx,
        south: Math.max(-85, south - dy),
        east: west + wide + dx,
        north: Math.min(85, north + dy),
    };
}

// Returns true if a circle about a place meets the view.
export function reaches(view: MapView, place: Place, radiusM: number): boolean {
    const [x, y] = pixelOf(view, mapPoint(place));
    const aside = Math.hypot(Math.max(0, -x, x - view.width), Math.max(0, -y, y - view.height));
    return aside <= (radiusM * view.scale) / (equatorM * Math.cos(place.latitudeDeg * radians));
}

export function holdsBox(outer: MapBox, inner: MapBox): boolean {
    const [wide, own] = [outer.east - outer.west, inner.east - inner.west];
    const isWithin = wide >= 360 || turned(inner.west - outer.west) + own <= wide;
    return isWithin && outer.south <= inner.south && outer.north >= inner.north;
}

export function isInBox(place: Place, box: MapBox): boolean {
    if (place.latitudeDeg < box.south || place.latitudeDeg > box.north) return false;
    return turned(place.longitudeDeg - box.west) <= box.east - box.west;
}
