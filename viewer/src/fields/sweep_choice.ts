// Chooses the sweep to show, and its site.

import { GridPlane, Plane } from '../earth/projection';
import { SweepRow } from '../wire/api';
import { Site } from '../wire/packed_grid';

const sameElevationDeg = 0.2; // as in include/stormcellar/grid/sweep_choice.h

const has = (row: SweepRow, moment: string): boolean => row.moments.some((one) => one.moment === moment);
const isSameElevation = (one: number, other: number): boolean => Math.abs(one - other) <= sameElevationDeg;

// Returns the cuts that have the moment, grouped by rising elevation; cuts of a group are in the order of the volume.
export function tiltsOf(rows: SweepRow[], moment: string): SweepRow[][] {
    const rising = rows.filter((row) => has(row, moment)).sort((a, b) => a.elevation_deg - b.elevation_deg);
    const groups: SweepRow[][] = [];
    for (const row of rising) {
        const last = groups[groups.length - 1];
        if (last && isSameElevation(last[0]!.elevation_deg, row.elevation_deg)) last.push(row);
        else groups.push([row]);
    }
    return groups.map((group) => group.sort((a, b) => a.sweep - b.sweep));
}

// Returns true if `stormcellar frame --product ppi` draws this cut of all cuts at its elevation.
export const isChosen = (row: SweepRow, moment: string): boolean =>
    row.moments.some((one) => one.moment === moment && one.chosen === true);

// Number of a cut in its volume. 'first' is the first repeat of the cut that pictures take; null is the cut itself.
export type CutNumber = number | 'first' | null;

// Returns the cuts of the tilt of `row` that measure as `row` does, in order of time. SAILS and MRLE repeat low cuts.
export function repeatsOf(rows: SweepRow[], moment: string, { sweep, moments }: SweepRow): SweepRow[] {
    const isDoppler = (of: SweepRow['moments']) => of.some((one) => one.moment === 'VEL');
    const tilt = tiltsOf(rows, moment).find((one) => one.some((row) => row.sweep === sweep)) ?? [];
    return tilt.filter((row) => isDoppler(row.moments) === isDoppler(moments));
}

// Returns the cut to show; null if no cut has the moment. This is the cut `number` if it is at the elevation and has
// the moment. Otherwise it is the cut nearest to the elevation among the cuts that pictures take, or among all cuts if
// pictures take none.
export function cutOf(rows: SweepRow[], moment: string, elevationDeg: number, number: CutNumber): SweepRow | null {
    const having = rows.filter((row) => has(row, moment));
    const named = having.find((row) => row.sweep === number && isSameElevation(row.elevation_deg, elevationDeg));
    if (named) return named;
    const chosen = having.filter((row) => isChosen(row, moment));
    const off = (row: SweepRow) => Math.abs(row.elevation_deg - elevationDeg);
    const best = (chosen.length > 0 ? chosen : having).reduce<SweepRow | null>(
        (best, row) => (best === null || off(row) < off(best) ? row : best),
        null,
    );
    return number === 'first' && best ? (repeatsOf(rows, moment, best)[0] ?? null) : best;
}

// Returns the cut of the next higher tilt (`by` is 1) or lower tilt (-1) that pictures take; null if there is none.
export function nextTilt(rows: SweepRow[], moment: string, { sweep }: SweepRow, by: 1 | -1): SweepRow | null {
    const tilts = tiltsOf(rows, moment);
    const at = tilts.findIndex((tilt) => tilt.some((row) => row.sweep === sweep));
    const next = at < 0 ? undefined : tilts[at + by];
    return next?.find((row) => isChosen(row, moment)) ?? next?.[0] ?? null;
}

// Returns the purpose of a half of a split cut; an empty text for a whole cut.
export function kindOf(row: SweepRow, rows: SweepRow[]): 'surveillance' | 'doppler' | '' {
    const isDoppler = has(row, 'VEL');
    const isSplit = rows.some(
        (other) => isSameElevation(other.elevation_deg, row.elevation_deg) && has(other, 'VEL') !== isDoppler,
    );
    if (!isSplit) return '';
    return isDoppler ? 'doppler' : 'surveillance';
}

// Returns the site nearest to a place; null without sites.
export function nearestSite(sites: Site[], plane: GridPlane, [x, y]: Plane): Site | null {
    const off = (site: Site): number => {
        const at = plane.toPlane(site);
        return at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
    };
    return sites.reduce<Site | null>((best, site) => (best === null || off(site) < off(best) ? site : best), null);
}
