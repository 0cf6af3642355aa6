// Computes distances, azimuths and areas on the ellipsoid of WGS84.
//
// Distances are from geodesic(), and accurate to millimeters. Areas are accurate to some 1e-6, because each side is
// divided into steps along its geodesic, which are straight on the sphere of equal area.

import { Place, destination, geodesic } from './projection';

const a = 6378137;
const f = 1 / 298.257223563;
const e2 = f * (2 - f);
const e = Math.sqrt(e2);
const radians = Math.PI / 180;
const longestStepM = 20_000;

export interface Leg {
    distanceM: number;
    azimuthDeg: number; // direction at the beginning of the leg, clockwise from north
}

export function legOf(from: Place, to: Place): Leg {
    const { distanceM, azimuth } = geodesic(from, to);
    return { distanceM, azimuthDeg: (azimuth / radians + 360) % 360 };
}

// Returns the sine of the authalic latitude, times its value at the pole (Snyder 1987, eq 3-12).
function equalAreaSine(latitudeDeg: number): number {
    const sine = Math.sin(latitudeDeg * radians);
    return (1 - e2) * (sine / (1 - e2 * sine * sine) - Math.log((1 - e * sine) / (1 + e * sine)) / (2 * e));
}

// Returns the area of a polygon whose sides are geodesics. It must not contain a pole.
export function areaM2(corners: Place[]): number {
    if (corners.length < 3) return 0;
    const points: Place[] = corners.flatMap((from, i) => {
        const to = corners[(i + 1) % corners.length]!;
        const { distanceM, azimuth } = geodesic(from, to);
        const steps = Math.max(1, Math.ceil(distanceM / longestStepM));
        return Array.from({ length: steps }, (_, k) => destination(from, azimuth, (distanceM * k) / steps));
    });
    let twice = 0;
    points.forEach((from, i) => {
        const to = points[(i + 1) % points.length]!;
        const across = ((((to.longitudeDeg - from.longitudeDeg + 180) % 360) + 360) % 360) - 180;
        twice += across * radians * (equalAreaSine(from.latitudeDeg) + equalAreaSine(to.latitudeDeg));
    });
    return (Math.abs(twice) / 4) * a * a;
}
