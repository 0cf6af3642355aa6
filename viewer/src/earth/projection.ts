// Converts places on the earth to a grid's plane, in meters from the middle of the grid, and back.
//
// There are three projections: azimuthal equidistant by geodesics of WGS84 (Vincenty 1975, to millimeters except near
// the antipode), Lambert conformal conic of the ellipsoid (Snyder 1987, pp 107-109), and latitude and longitude. For
// the third, a degree has the same drawn length everywhere as at the center, as in pictures.

import { projections } from '../facts';
import { GridPlace } from '../wire/packed_grid';

const a = 6378137;
const f = 1 / 298.257223563;
const b = a * (1 - f);
const e2 = f * (2 - f);
const e = Math.sqrt(e2);
const radians = Math.PI / 180;

export interface Place {
    latitudeDeg: number;
    longitudeDeg: number;
}
export type Plane = [number, number];

export interface GridPlane {
    toPlane(place: Place): Plane | null;
    toPlace(plane: Plane): Place;
}

function wrapped(degrees: number): number {
    return ((((degrees + 180) % 360) + 360) % 360) - 180;
}

interface Geodesic {
    distanceM: number;
    azimuth: number; // radians, at the first place
}

export function geodesic(from: Place, to: Place): Geodesic {
    const u1 = Math.atan((1 - f) * Math.tan(from.latitudeDeg * radians));
    const u2 = Math.atan((1 - f) * Math.tan(to.latitudeDeg * radians));
    const l = wrapped(to.longitudeDeg - from.longitudeDeg) * radians;
    const [s1, c1, s2, c2] = [Math.sin(u1), Math.cos(u1), Math.sin(u2), Math.cos(u2)];
    let lambda = l;
    let [sinSigma, cosSigma, sigma, cos2Alpha, cosM] = [0, 1, 0, 1, 1];
    for (let i = 0; i < 100; ++i) {
        const [sl, cl] = [Math.sin(lambda), Math.cos(lambda)];
        sinSigma = Math.hypot(c2 * sl, c1 * s2 - s1 * c2 * cl);
        if (sinSigma === 0) return { distanceM: 0, azimuth: 0 };
        cosSigma = s1 * s2 + c1 * c2 * cl;
        sigma = Math.atan2(sinSigma, cosSigma);
        const sinAlpha = (c1 * c2 * sl) / sinSigma;
        cos2Alpha = 1 - sinAlpha * sinAlpha;
        cosM = cos2Alpha > 0 ? cosSigma - (2 * s1 * s2) / cos2Alpha : 0;
        const c = (f / 16) * cos2Alpha * (4 + f * (4 - 3 * cos2Alpha));
        const next =
            l + (1 - c) * f * sinAlpha * (sigma + c * sinSigma * (cosM + c * cosSigma * (2 * cosM * cosM - 1)));
        const isSettled = Math.abs(next - lambda) < 1e-12;
        lambda = next;
        if (isSettled) break;
    }
    const uu = (cos2Alpha * (a * a - b * b)) / (b * b);
    const aa = 1 + (uu / 16384) * (4096 + uu * (-768 + uu * (320 - 175 * uu)));
    const bb = (uu / 1024) * (256 + uu * (-128 + uu * (74 - 47 * uu)));
    const correction =
        bb *
        sinSigma *
        (cosM +
            (bb / 4) *
                (cosSigma * (2 * cosM * cosM - 1) -
                    (bb / 6) * cosM * (4 * sinSigma * sinSigma - 3) * (4 * cosM * cosM - 3)));
    return {
        distanceM: b * aa * (sigma - correction),
        azimuth: Math.atan2(c2 * Math.sin(lambda), c1 * s2 - s1 * c2 * Math.cos(lambda)),
    };
}

// Returns the place at a distance and an azimuth from the place `from`.
export function destination(from: Place, azimuth: number, distanceM: number): Place {
    if (distanceM === 0) return from;
    const u1 = Math.atan((1 - f) * Math.tan(from.latitudeDeg * radians));
    const [s1, c1, sa, ca] = [Math.sin(u1), Math.cos(u1), Math.sin(azimuth), Math.cos(azimuth)];
    const sigma1 = Math.atan2(Math.tan(u1), ca);
    const sinAlpha = c1 * sa;
    const cos2Alpha = 1 - sinAlpha * sinAlpha;
    const uu = (cos2Alpha * (a * a - b * b)) / (b * b);
    const aa = 1 + (uu / 16384) * (4096 + uu * (-768 + uu * (320 - 175 * uu)));
    const bb = (uu / 1024) * (256 + uu * (-128 + uu * (74 - 47 * uu)));
    let sigma = distanceM / (b * aa);
    let cosM = 1;
    for (let i = 0; i < 100; ++i) {
        cosM = Math.cos(2 * sigma1 + sigma);
        const [ss, cs] = [Math.sin(sigma), Math.cos(sigma)];
        const change =
            bb *
            ss *
            (cosM +
                (bb / 4) * (cs * (2 * cosM * cosM - 1) - (bb / 6) * cosM * (4 * ss * ss - 3) * (4 * cosM * cosM - 3)));
        const next = distanceM / (b * aa) + change;
        const isSettled = Math.abs(next - sigma) < 1e-13;
        sigma = next;
        if (isSettled) break;
    }
    const [ss, cs] = [Math.sin(sigma), Math.cos(sigma)];
    const latitude = Math.atan2(s1 * cs + c1 * ss * ca, (1 - f) * Math.hypot(sinAlpha, s1 * ss - c1 * cs * ca));
    const lambda = Math.atan2(ss * sa, c1 * cs - s1 * ss * ca);
    const c = (f / 16) * cos2Alpha * (4 + f * (4 - 3 * cos2Alpha));
    const l = lambda - (1 - c) * f * sinAlpha * (sigma + c * ss * (cosM + c * cs * (2 * cosM * cosM - 1)));
    return { latitudeDeg: latitude / radians, longitudeDeg: wrapped(from.longitudeDeg + l / radians) };
}

function azimuthalEquidistant(center: Place): GridPlane {
    return {
        toPlane(place) {
            const { distanceM, azimuth } = geodesic(center, place);
            return [distanceM * Math.sin(azimuth), distanceM * Math.cos(azimuth)];
        },
        toPlace([x, y]) {
            return destination(center, Math.atan2(x, y), Math.hypot(x, y));
        },
    };
}

// Returns the meters of a degree at a latitude, along the parallel and along the meridian.
function metersOfADegree(latitudeDeg: number): [number, number] {
    const sine = Math.sin(latitudeDeg * radians);
    const w = Math.sqrt(1 - e2 * sine * sine);
    return [(a / w) * Math.cos(latitudeDeg * radians) * radians, ((a * (1 - e2)) / w ** 3) * radians];
}

function latitudeLongitude(center: Place): GridPlane {
    const [east, north] = metersOfADegree(center.latitudeDeg);
    return {
        toPlane: (place) => [
            wrapped(place.longitudeDeg - center.longitudeDeg) * east,
            (place.latitudeDeg - center.latitudeDeg) * north,
        ],
        toPlace: ([x, y]) => ({
            latitudeDeg: center.latitudeDeg + y / north,
            longitudeDeg: wrapped(center.longitudeDeg + x / east),
        }),
    };
}

function lambert(center: Place, parallelsDeg: [number, number]): GridPlane {
    const t = (latitude: number) =>
        Math.tan(Math.PI / 4 - latitude / 2) / ((1 - e * Math.sin(latitude)) / (1 + e * Math.sin(latitude))) ** (e / 2);
    const m = (latitude: number) => Math.cos(latitude) / Math.sqrt(1 - e2 * Math.sin(latitude) ** 2);
    const [p1, p2] = parallelsDeg.map((degrees) => degrees * radians) as [number, number];
    const n = Math.abs(p1 - p2) < 1e-9 ? Math.sin(p1) : Math.log(m(p1) / m(p2)) / Math.log(t(p1) / t(p2));
    const scale = (a * m(p1)) / (n * t(p1) ** n);
    const rho = (latitude: number) => scale * t(latitude) ** n;
    const rho0 = rho(center.latitudeDeg * radians);
    return {
        toPlane(place) {
            const theta = n * wrapped(place.longitudeDeg - center.longitudeDeg) * radians;
            const r = rho(place.latitudeDeg * radians);
            return Number.isFinite(r) ? [r * Math.sin(theta), rho0 - r * Math.cos(theta)] : null;
        },
        toPlace([x, y]) {
            const r = Math.sign(n) * Math.hypot(x, rho0 - y);
            const theta = Math.atan2(Math.sign(n) * x, Math.sign(n) * (rho0 - y));
            const tt = (r / scale) ** (1 / n);
            let latitude = Math.PI / 2 - 2 * Math.atan(tt);
            for (let i = 0; i < 20; ++i) {
                const es = e * Math.sin(latitude);
                latitude = Math.PI / 2 - 2 * Math.atan(tt * ((1 - es) / (1 + es)) ** (e / 2));
            }
            return {
                latitudeDeg: latitude / radians,
                longitudeDeg: wrapped(center.longitudeDeg + theta / n / radians),
            };
        },
    };
}

// Returns the number of a projection in packed grids. Throws an Error for an unknown name.
export function projectionNamed(name: string): number {
    const found = Object.entries(projections).find(([own]) => own === name);
    if (!found) throw new Error(`${name}: no such projection`);
    return found[1].number;
}

function isInDegrees(projection: number): boolean {
    const found = Object.values(projections).find(({ number }) => number === projection);
    if (!found) throw new Error(`${projection}: no such projection`);
    return found.isInDegrees;
}

// Returns the widths of a cell to the east and to the north, in drawn meters.
export function cellSizeM(grid: GridPlace): [number, number] {
    if (!isInDegrees(grid.projection)) return [grid.spacing, grid.spacing];
    const [east, north] = metersOfADegree(grid.centerDeg[0]);
    return [grid.spacing * east, grid.spacing * north];
}

// Returns half of the grid's extent to the east and to the north, in drawn meters.
export function halfWidthsM(grid: GridPlace): [number, number] {
    const [width, height] = cellSizeM(grid);
    return [0.5 * grid.nx * width, 0.5 * grid.ny * height];
}

function projected({ projection, parallelsDeg }: GridPlace, center: Place): GridPlane {
    switch (projection) {
        case projections.azimuthal_equidistant.number:
            return azimuthalEquidistant(center);
        case projections.latitude_longitude.number:
            return latitudeLongitude(center);
        case projections.lambert_conformal.number:
            return lambert(center, parallelsDeg);
        default:
            throw new Error(`${projection}: no such projection`);
    }
}

// Returns a grid's plane. Its origin is the middle of the grid, which may be off the center of the projection.
export function planeOf(grid: GridPlace): GridPlane {
    const center: Place = { latitudeDeg: grid.centerDeg[0], longitudeDeg: grid.centerDeg[1] };
    const own = projected(grid, center);
    const [width, height] = cellSizeM(grid);
    const [dx, dy] = [grid.offsetCells[0] * width, grid.offsetCells[1] * height];
    return {
        toPlane(place) {
            const at = own.toPlane(place);
            return at && [at[0] - dx, at[1] - dy];
        },
        toPlace: ([x, y]) => own.toPlace([x + dx, y + dy]),
    };
}

// Returns where the middle of `grid` is on the plane of the grid `plane`. Both have the same center of projection, as a
// window and its grid do.
export function middleOn(plane: GridPlace, grid: GridPlace): Plane {
    const [whole, own] = [cellSizeM(plane), cellSizeM(grid)];
    return [
        grid.offsetCells[0] * own[0] - plane.offsetCells[0] * whole[0],
        grid.offsetCells[1] * own[1] - plane.offsetCells[1] * whole[1],
    ];
}
