// Places a sweep over the earth: finds the radial of each azimuth, and the cone of its gates.
//
// All gates are drawn at the sweep's mean elevation. A beam is a straight line over a sphere of 4/3 of the Gaussian
// earth radius (docs/geometry.md).

import { Plane, GridPlane, Place, destination } from '../earth/projection';
import { PackedSweep } from '../wire/packed_sweep';

const semiMajorM = 6378137;
const flattening = 1 / 298.257223563;
const radians = Math.PI / 180;

// Returns the radius of the sphere over which a beam is straight.
function beamSphereM(latitudeDeg: number): number {
    const sine = Math.sin(latitudeDeg * radians);
    const gaussian = (semiMajorM * (1 - flattening)) / (1 - flattening * (2 - flattening) * sine * sine);
    return (4 / 3) * gaussian;
}

interface Antenna {
    latitudeDeg: number;
    altitudeM: number;
}

// Returns where a beam is at a slant range: the arc along the earth at sea level, and the height above sea level.
export function beamAt(site: Antenna, elevationDeg: number, rangeM: number): { arcM: number; heightM: number } {
    const radius = beamSphereM(site.latitudeDeg);
    const antenna = radius + site.altitudeM;
    const up = rangeM * Math.sin(elevationDeg * radians);
    const along = rangeM * Math.cos(elevationDeg * radians);
    const q = rangeM * rangeM + 2 * antenna * up;
    return {
        arcM: radius * Math.atan2(along, antenna + up),
        heightM: site.altitudeM + q / (Math.sqrt(antenna * antenna + q) + antenna),
    };
}

// Finds the beam that meets a point. This is the inverse of beamAt().
export function beamTo(site: Antenna, arcM: number, heightM: number): { elevationDeg: number; rangeM: number } {
    const radius = beamSphereM(site.latitudeDeg);
    const along = (radius + heightM) * Math.sin(arcM / radius);
    const up = (radius + heightM) * Math.cos(arcM / radius) - (radius + site.altitudeM);
    return { elevationDeg: Math.atan2(up, along) / radians, rangeM: Math.hypot(along, up) };
}

// Returns the slant range at which a beam is above a place at an arc from the site. This is the inverse of beamAt().
export function rangeAt(site: Antenna, elevationDeg: number, arcM: number): number {
    const radius = beamSphereM(site.latitudeDeg);
    const turn = arcM / radius;
    return ((radius + site.altitudeM) * Math.sin(turn)) / Math.cos(turn + elevationDeg * radians);
}

export const azimuthSteps = 7200; // number of steps in a turn
export const noRadial = 65535;

// Finds the nearest radial for each step of azimuth. A gap is where two radials are more than one and a half median
// spacings apart; steps in a gap that are more than half a spacing from both radials get noRadial.
export function radialsByAzimuth({ azimuthsDeg, gateCounts }: PackedSweep): Uint16Array {
    const order = [...azimuthsDeg.keys()]
        .filter((i) => gateCounts[i]! > 0 && Number.isFinite(azimuthsDeg[i]!))
        .sort((a, b) => azimuthsDeg[a]! - azimuthsDeg[b]!);
    const found = new Uint16Array(azimuthSteps).fill(noRadial);
    if (order.length === 0) return found;
    const steps = order.map(
        (radial, i) => (azimuthsDeg[order[(i + 1) % order.length]!]! - azimuthsDeg[radial]! + 360) % 360 || 360,
    );
    const spacing = [...steps].sort((a, b) => a - b)[steps.length >> 1]!;
    let next = 0;
    for (let step = 0; step < azimuthSteps; ++step) {
        const azimuth = ((step + 0.5) * 360) / azimuthSteps;
        while (next < order.length && azimuthsDeg[order[next]!]! < azimuth) ++next;
        const after = order[next % order.length]!;
        const before = order[(next + order.length - 1) % order.length]!;
        const toAfter = (azimuthsDeg[after]! - azimuth + 360) % 360;
        const toBefore = (azimuth - azimuthsDeg[before]! + 360) % 360;
        const isGap = toAfter + toBefore > 1.5 * spacing;
        if (!isGap || Math.min(toAfter, toBefore) <= 0.5 * spacing) found[step] = toAfter < toBefore ? after : before;
    }
    return found;
}

export interface Cone {
    // Five numbers for each corner: x and y in meters from the middle of the grid, height above sea level in
    // meters, azimuth in degrees and slant range in meters.
    corners: Float32Array;
    triangles: Uint32Array;
}

const turns = 360; // steps of azimuth around a ring
const rings = 48;

export function coneOf(sweep: PackedSweep, plane: GridPlane): Cone {
    const site: Place = { latitudeDeg: sweep.latitudeDeg, longitudeDeg: sweep.longitudeDeg };
    const first = Math.max(0, sweep.firstGateM - 0.5 * sweep.gateSpacingM);
    const last = sweep.firstGateM + (Math.max(0, ...sweep.gateCounts) - 0.5) * sweep.gateSpacingM;
    const corners = new Float32Array(5 * (turns + 1) * (rings + 1));
    for (let ring = 0, at = 0; ring <= rings; ++ring) {
        const rangeM = first + (ring / rings) * (last - first);
        const beam = beamAt(sweep, sweep.elevationDeg, rangeM);
        for (let turn = 0; turn <= turns; ++turn, at += 5) {
            const azimuth = (turn * 360) / turns;
            const point: Plane = plane.toPlane(destination(site, azimuth * radians, beam.arcM)) ?? [NaN, NaN];
            corners.set([point[0], point[1], beam.heightM, azimuth, rangeM], at);
        }
    }
    const triangles = new Uint32Array(6 * turns * rings);
    for (let ring = 0, at = 0; ring < rings; ++ring) {
        for (let turn = 0; turn < turns; ++turn, at += 6) {
            const a = ring * (turns + 1) + turn;
            const b = a + turns + 1;
            triangles.set([a, a + 1, b, b, a + 1, b + 1], at);
        }
    }
    return { corners, triangles };
}
