// Reads storm cells from the GeoJSON of the data server (docs/web/grids.md).

import { Place } from '../earth/projection';

export interface CellAhead {
    minutes: number;
    place: Place;
    errorM: number; // standard deviation along each axis
}

// Unknown numbers are null.
export interface StormCell {
    id: string;
    place: Place;
    maxDbz: number;
    topM: number;
    isTopAtLeast: boolean; // the air above the top was not seen
    vilKgM2: number;
    meshMm: number | null;
    shearPerS: number | null;
    speedMps: number | null;
    fromDeg: number | null; // direction from which the cell comes
    speedErrorMps: number | null;
    track: Place[]; // the oldest first, with the cell's own place at the end
    ahead: CellAhead[];
}

interface Feature {
    geometry: { coordinates: unknown };
    properties: Record<string, unknown>;
}

const numberOf = (value: unknown): number | null => (typeof value === 'number' && isFinite(value) ? value : null);
const listOf = (value: unknown): unknown[] => (Array.isArray(value) ? (value as unknown[]) : []);

function placeOf(value: unknown): Place | null {
    const [longitudeDeg, latitudeDeg] = listOf(value).map(numberOf);
    return longitudeDeg == null || latitudeDeg == null ? null : { latitudeDeg, longitudeDeg };
}
const placesOf = (value: unknown): Place[] => listOf(value).flatMap((one) => placeOf(one) ?? []);

function cellOf({ geometry, properties }: Feature): StormCell | null {
    const place = placeOf(geometry.coordinates);
    const one = (name: string) => numberOf(properties[name]);
    const [east, north] = [one('motion_east_mps'), one('motion_north_mps')];
    const hasMotion = east !== null && north !== null;
    return (
        place && {
            id: String(properties['id']),
            place,
            maxDbz: one('max_dbz') ?? 0,
            topM: one('top_m') ?? 0,
            isTopAtLeast: properties['top_is_at_least'] === true,
            vilKgM2: one('vil_kg_per_m2') ?? 0,
            meshMm: one('mesh_mm'),
            shearPerS: one('azimuthal_shear_per_s'),
            speedMps: hasMotion ? Math.hypot(east, north) : null,
            fromDeg: hasMotion ? ((Math.atan2(-east, -north) * 180) / Math.PI + 360) % 360 : null,
            speedErrorMps: one('motion_error_mps'),
            track: [],
            ahead: [],
        }
    );
}

// Returns the cells of an answer, the strongest first. Parts that make no sense are left out.
export function readCells(answer: unknown): StormCell[] {
    const features = listOf((answer as { features?: unknown }).features) as Feature[];
    const cells = new Map<string, StormCell>();
    for (const feature of features) {
        const cell = feature.properties['kind'] === 'cell' ? cellOf(feature) : null;
        if (cell) cells.set(cell.id, cell);
    }
    for (const { geometry, properties } of features) {
        const cell = cells.get(String(properties['id']));
        if (!cell) continue;
        const places = placesOf(geometry.coordinates);
        if (properties['kind'] === 'track') cell.track = places;
        if (properties['kind'] !== 'forecast') continue;
        const [minutes, errors] = [listOf(properties['minutes']), listOf(properties['errors_m'])];
        cell.ahead = places.map((place, i) => ({
            place,
            minutes: numberOf(minutes[i]) ?? 0,
            errorM: numberOf(errors[i]) ?? 0,
        }));
    }
    return [...cells.values()].sort((a, b) => b.maxDbz - a.maxDbz);
}
