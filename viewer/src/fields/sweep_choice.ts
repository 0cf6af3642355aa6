// Which sweep of which site is meant.

import { GridPlane, Plane } from '../scene/projection';
import { SweepRow } from '../wire/api';
import { Site } from '../wire/packed_grid';

const sameElevationDeg = 0.15;

// The nearest one that has the moment; where the antenna came back to an elevation, the last. Null if
// none has it.
export function nearestSweep(rows: SweepRow[], moment: string, elevationDeg: number): SweepRow | null {
    const having = rows.filter(row => row.moments.some(one => one.moment === moment));
    if (having.length === 0) return null;
    const off = (row: SweepRow) => Math.abs(row.elevation_deg - elevationDeg);
    const nearest = having.reduce((best, row) => (off(row) < off(best) ? row : best));
    return having.filter(row => Math.abs(row.elevation_deg - nearest.elevation_deg) < sameElevationDeg).pop()!;
}

// The elevations that have the moment, each once, rising.
export function elevationsOf(rows: SweepRow[], moment: string): number[] {
    const all = rows.filter(row => row.moments.some(one => one.moment === moment)).map(row => row.elevation_deg);
    return all.sort((a, b) => a - b).filter((one, i) => i === 0 || one - all[i - 1]! >= sameElevationDeg);
}

// The site that is nearest to a place; null without sites.
export function nearestSite(sites: Site[], plane: GridPlane, [x, y]: Plane): Site | null {
    const off = (site: Site): number => {
        const at = plane.toPlane(site);
        return at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
    };
    return sites.reduce<Site | null>((best, site) => (best === null || off(site) < off(best) ? site : best), null);
}
