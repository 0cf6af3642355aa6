// Finds the beam that saw a point of a grid, and the time at which the beam saw the point. Finds the error that the
// grid's audit states for values at the point.

import { Place, geodesic } from '../earth/projection';
import { GridFacts, SweepTime } from '../wire/api';
import { Site } from '../wire/packed_grid';
import { beamTo } from './sweep_cone';

export interface BeamReading {
    icao: string;
    rangeM: number;
    azimuthDeg: number;
    elevationDeg: number; // elevation of a beam through the point
    widthM: number; // width of the beam at the point, between half-power points
    sweepDeg: number | null; // elevation of the nearest sweep; null if the facts list no sweeps
    timeMs: number | null; // time at which that sweep saw the azimuth of the point; null if unknown
    // Difference of the grid from the gates of the nearest audited sweep at this range; null if unknown.
    rms: number | null;
}

// Returns the beam width between half-power points, as grid::beam_width_of() does. Names of TDWRs begin with T.
const beamWidthDeg = (icao: string): number => (icao.startsWith('T') && icao !== 'TJUA' ? 0.55 : 0.95);
const radians = Math.PI / 180;

export const beamWidthM = (icao: string, rangeM: number): number => rangeM * beamWidthDeg(icao) * radians;

function nearest(sweeps: SweepTime[], elevationDeg: number): SweepTime | null {
    let best: SweepTime | null = null;
    for (const sweep of sweeps) {
        if (!best || Math.abs(sweep.elevation_deg - elevationDeg) < Math.abs(best.elevation_deg - elevationDeg))
            best = sweep;
    }
    return best;
}

function timeOf(sweep: SweepTime, azimuthDeg: number): number | null {
    if (!(Math.abs(sweep.degrees_per_s) > 0)) return null;
    const turned =
        sweep.degrees_per_s > 0 ? azimuthDeg - sweep.first_azimuth_deg : sweep.first_azimuth_deg - azimuthDeg;
    return Date.parse(sweep.start) + (1000 * (((turned % 360) + 360) % 360)) / Math.abs(sweep.degrees_per_s);
}

// Returns the site nearest to a place, and the geodesic from the site to the place; null without sites.
export function nearestTo(
    sites: Site[],
    place: Place,
): { site: Site; way: { distanceM: number; azimuth: number } } | null {
    return (
        sites
            .map((site) => ({ site, way: geodesic(site, place) }))
            .sort((a, b) => a.way.distanceM - b.way.distanceM)[0] ?? null
    );
}

// Returns the beam of the site that is nearest to the point; null without sites. If `facts` is null, sweep, time and
// rms are null.
export function beamReading(sites: Site[], facts: GridFacts | null, place: Place, heightM: number): BeamReading | null {
    const first = nearestTo(sites, place);
    if (!first) return null;
    const { site, way } = first;
    const { elevationDeg, rangeM } = beamTo(site, way.distanceM, heightM);
    const sweep = nearest(facts?.provenance.sweeps ?? [], elevationDeg);
    const azimuthDeg = (way.azimuth / radians + 360) % 360;
    const rows = (facts?.audit?.rows ?? []).filter(
        (row) => row.count > 0 && rangeM >= row.range_from_m && rangeM < (row.range_to_m ?? Infinity),
    );
    const row = rows.sort(
        (a, b) => Math.abs(a.elevation_deg - elevationDeg) - Math.abs(b.elevation_deg - elevationDeg),
    )[0];
    return {
        icao: site.icao,
        rangeM,
        azimuthDeg,
        elevationDeg,
        widthM: beamWidthM(site.icao, rangeM),
        sweepDeg: sweep?.elevation_deg ?? null,
        timeMs: sweep && timeOf(sweep, azimuthDeg),
        rms: row?.rms ?? null,
    };
}
