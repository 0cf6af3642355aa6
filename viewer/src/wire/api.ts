// Asks the data server (docs/web/grids.md).
//
// Errors: an ApiError with status and text if the server refuses, and a TypeError if it does not answer.

import { mapKinds } from '../facts';
import { ColorTable } from './color_tables';
import { isRegion, sidesOf } from './region';

export { isRegion, regionName } from './region';

export class ApiError extends Error {
    constructor(
        readonly status: number,
        message: string,
    ) {
        super(message);
    }
}

// Returns true if the server answered that it does not have what was asked for (404 or 410).
export const isAbsent = (error: unknown): boolean =>
    error instanceof ApiError && (error.status === 404 || error.status === 410);

export interface MomentOfDomain {
    moment: string;
    units: string;
    grids: number;
    newest: string;
    age_s: number; // age of the newest grid
}
export interface Domain {
    domain: string;
    part_of: string | null;
    moments: MomentOfDomain[];
}
export interface Newest {
    time: string;
    age_s: number;
}
export interface Station {
    station: string;
    name?: string; // unknown members are left out
    state?: string;
    latitude_deg?: number;
    longitude_deg?: number;
    newest_volume?: Newest | null; // left out if the server cannot read it now
    newest_grid: Newest | null;
    moments: string[];
    silent_s?: number | null; // seconds since data came from a silent station; null: it is not silent
}
// The facts of a grid that the page uses.
export interface GridFacts {
    id: string; // changes if the grid is made again
    time: string;
    projection: string;
    center: [number, number];
    spacing_m?: number;
    spacing_deg?: number;
    parallels_deg?: [number, number];
    offset_cells: [number, number];
    nx: number;
    ny: number;
    greatest: number | null;
    provenance: {
        source_files: string[];
        stations: string[];
        predicted_error: string;
        radar_troubles: string[]; // faults that radars reported: "KTLX: standby, ..."
        sweeps: SweepTime[];
    };
    audit: { unit: string; summary: string; rows: AuditRow[] } | null;
}
// A sweep of the grid's volume: when and where it began, and how fast the antenna turned.
export interface SweepTime {
    elevation_deg: number;
    start: string;
    first_azimuth_deg: number;
    degrees_per_s: number;
}
// Difference between the grid's values and the gates of a sweep in an interval of range.
export interface AuditRow {
    elevation_deg: number;
    range_from_m: number;
    range_to_m: number | null;
    count: number;
    rms: number;
}
// Several sites within a box, as one domain (docs/web/grids.md#regions).
export interface Region extends Domain {
    moments: (MomentOfDomain & {
        sites: string[];
        left_out: string[];
        spacing_m: number;
        halved: number;
        times: string[];
    })[];
}
export type MapKind = keyof typeof mapKinds;
export interface MapLine {
    kind: MapKind;
    is_area: boolean;
    points: [number, number][]; // longitude, latitude
}
export interface City {
    name: string;
    population: number;
    place: [number, number];
}
export interface MapAnswer {
    credit: string;
    lines: MapLine[];
    cities: City[];
}

// The page is at BASE/view/.
const base = new URL('..', document.baseURI);
export const address = (path: string): string => new URL(path.replace(/^\//, ''), base).href;

// Greatest width of a map. It is a little less than 360, because sides are rounded.
const mostWideDeg = 359.99;

const busy = 503; // status of a server that is busy with other requests; the page then asks again
const mostTries = 10;

// Returns the time of the server in ms since 1970; NaN if the answer has no date.
export const timeOf = (answer: Response): number => Date.parse(answer.headers.get('Date') ?? '');

// Header of the server's own refusals. A proxy answers without it if the server is gone or the proxy wants a password;
// the page then acts as if there was no answer. Answers in HTML are also from a proxy.
const ownRefusal = 'Stormcellar-Status';

async function ask(path: string, options: RequestInit = {}): Promise<Response> {
    let answer = await fetch(address(path), options);
    for (let tries = 0; answer.status === busy && answer.headers.has(ownRefusal) && tries < mostTries; ++tries) {
        await new Promise((done) => setTimeout(done, 1000 * Number(answer.headers.get('Retry-After') ?? 1)));
        answer = await fetch(address(path), options);
    }
    const { ok, status, statusText, headers } = answer;
    if (ok && !headers.get('Content-Type')?.includes('html')) return answer;
    if (!headers.has(ownRefusal)) throw new TypeError('no answer');
    const refusal = (await answer.json().catch(() => null)) as { error: string } | null;
    throw new ApiError(status, refusal?.error ?? (statusText || String(status)));
}

const told = async <T>(path: string): Promise<T> => (await ask(path)).json() as Promise<T>;
const bytesOf = async (path: string, options?: RequestInit): Promise<ArrayBuffer> =>
    (await ask(path, options)).arrayBuffer();

export async function domains(): Promise<Domain[]> {
    return (await told<{ domains: Domain[] }>('api/v1/domains')).domains;
}
export async function stations(): Promise<Station[]> {
    return (await told<{ stations: Station[] }>('api/v1/stations')).stations;
}
// Returns the silent stations, each with the seconds since data came from it, the names of stations, and the time of
// the server. Also returns the stations of which the server does not know whether they are silent, with undefined
// instead of seconds.
export async function silences(): Promise<{
    silent: [string, number | undefined][];
    names: [string, string][];
    serverMs: number;
}> {
    const answer = await ask('api/v1/stations');
    const { stations } = (await answer.json()) as { stations: Station[] };
    const silent = stations.flatMap(({ station, silent_s }): [string, number | undefined][] =>
        silent_s === null ? [] : [[station, silent_s]],
    );
    const names = stations.map(({ station, name, state }): [string, string] => [
        station,
        [name, state].filter(Boolean).join(', '),
    ]);
    return { silent, names, serverMs: timeOf(answer) };
}
// Returns the name of a station that the server knows, even without data of it; null if it does not know the station.
export async function nameOfKnown(icao: string): Promise<string | null> {
    const { stations } = await told<{ stations: Station[] }>(`api/v1/stations?known=1&station=${icao}`);
    return stations[0]?.name ?? null;
}
export function gridFacts(domain: string, moment: string, time: string): Promise<GridFacts> {
    return told(gridPath(domain, moment, time));
}
export async function region(domain: string): Promise<Region> {
    const [west, south, east, north] = sidesOf(domain).split(',');
    const query = new URLSearchParams({ west: west ?? '', south: south ?? '', east: east ?? '', north: north ?? '' });
    const found = await told<Omit<Region, 'part_of'>>(`api/v1/regions?${query}`);
    return { ...found, domain, part_of: null };
}
// The volumes of a site that are in a grid of a region, and the seconds from the grid's instant to their middles.
export interface RegionSite {
    site: string;
    volumes: { time: string; middle_s: number }[];
}
export interface RegionSites {
    sites: RegionSite[];
    left_out_because: Record<string, string>; // reason for each site that is not in the picture
}
export function regionSites(domain: string, moment: string, time: string): Promise<RegionSites> {
    return told(`${gridPath(domain, moment, time)}/sites`);
}
export interface Times {
    times: string[]; // rising
    more: boolean; // the server has older times
}
// Returns the times of a domain's grids up to `to`, inclusive. If there are more than `limit` (at most 10,000), returns
// the newest of them. `limit` does not apply to a region.
export async function times(domain: string, moment: string, limit: number, to?: string): Promise<Times> {
    if (isRegion(domain)) {
        const found = (await region(domain)).moments.find((one) => one.moment === moment);
        return { times: found?.times.filter((time) => to === undefined || time <= to) ?? [], more: false };
    }
    const until = to === undefined ? '' : `&to=${encodeURIComponent(to)}`;
    const path = `api/v1/grids?domain=${encodeURIComponent(domain)}&moment=${moment}&limit=${limit}${until}`;
    const { grids, more } = await told<{ grids: { time: string }[]; more: boolean }>(path);
    return { times: grids.map((grid) => grid.time), more };
}
export const gridPath = (domain: string, moment: string, time: string): string =>
    isRegion(domain)
        ? `api/v1/regions/${sidesOf(domain)}/${moment}/${encodeURIComponent(time)}`
        : `api/v1/grids/${encodeURIComponent(domain)}/${moment}/${encodeURIComponent(time)}`;
export const rawPath = (station: string, name: string): string =>
    address(`volumes/${encodeURIComponent(station)}/${encodeURIComponent(name)}`);
// Returns a packed grid, or a part of a grid in packed form. docs/web/packed-grid.md describes the parameters in
// `query`.
export function packed(
    domain: string,
    moment: string,
    time: string,
    query: Record<string, string>,
    signal?: AbortSignal,
): Promise<ArrayBuffer> {
    // Without an id, check with the server that a cached answer is still right, because the grid may have been made
    // again and bricks of two grids do not fit together.
    const options: RequestInit = { ...(query['id'] === undefined && { cache: 'no-cache' }), ...(signal && { signal }) };
    return bytesOf(`${gridPath(domain, moment, time)}/packed?${new URLSearchParams(query)}`, options);
}
// The view that the server fits to the echo of a grid. Meters are east and north of the middle of the grid, and above
// sea level.
export interface FittedView {
    camera: {
        azimuth_deg: number;
        tilt_deg: number;
        field_of_view_deg: number;
        place_m: [number, number, number] | null; // null: outside the grid, as for a grid without echo
    };
    focus_m: [number, number, number]; // as deep in the picture as the middle of the echo
    exaggeration: number;
    opacity: number;
    has_echo: boolean;
}
// Returns the view that the server fits to the echo of a stored grid, for a picture of this size in pixels.
export function fittedView(
    domain: string,
    moment: string,
    time: string,
    width: number,
    height: number,
): Promise<FittedView> {
    const query = new URLSearchParams({ width: String(width), height: String(height) });
    return told(`${gridPath(domain, moment, time)}/view?${query}`);
}
// Returns a whole grid that the server makes on request, for a region or for an instant between volumes.
export function packedBetween(domain: string, moment: string, time: string): Promise<ArrayBuffer> {
    const path = isRegion(domain)
        ? `${gridPath(domain, moment, time)}/packed`
        : `api/v1/between/${encodeURIComponent(domain)}/${moment}/${encodeURIComponent(time)}`;
    return bytesOf(path);
}
// Opens the stream of events after the event `id`, or of new events if `id` is empty. Errors are as in fetch().
export function askEvents(id: string, signal: AbortSignal): Promise<Response> {
    const query = id === '' ? '' : `?last_event_id=${encodeURIComponent(id)}`;
    return fetch(address(`api/v1/events${query}`), {
        cache: 'no-store',
        headers: { Accept: 'text/event-stream' },
        signal,
    });
}
// Returns the storm cells of a domain at a time as GeoJSON, which page/storm_cells.ts reads.
export function cells(domain: string, time: string): Promise<unknown> {
    return told(`api/v1/cells?${new URLSearchParams({ area: domain, time })}`);
}
// Returns the names of the server's overlays, which are files of lines and points, such as warnings.
export async function overlayNames(): Promise<string[]> {
    return (await told<{ overlays: { name: string }[] }>('overlays')).overlays.map(({ name }) => name);
}
// Returns an overlay as GeoJSON, which overlay/geojson_shapes.ts reads, and the files that are not in it, with reasons.
export async function overlayShapes(name: string): Promise<{ left_out?: string[] }> {
    const answer = await ask(`overlays/${encodeURIComponent(name)}.geojson`, { cache: 'no-cache' });
    return (await answer.json()) as { left_out?: string[] };
}
// Returns the address of a picture that the server draws of a stored grid, and a function that fetches the picture.
// `options` are options of `stormcellar frame` with their values: ['--opacity', '2'].
export function stillPicture(
    domain: string,
    moment: string,
    time: string,
    options: readonly string[],
    width: number,
    height: number,
): { path: string; fetch: () => Promise<Blob> } {
    const query = new URLSearchParams({ moment, time, width: String(width), height: String(height) });
    for (let i = 0; i + 1 < options.length; i += 2) query.set(options[i]!.replace('--', ''), options[i + 1]!);
    const path = `frames/${encodeURIComponent(domain)}.png?${query}`;
    return { path, fetch: async () => (await ask(path)).blob() };
}
export interface Tables {
    tables: ColorTable[];
    usual: Record<string, string>; // name of the usual table of each moment
}
export function tables(): Promise<Tables> {
    return told('api/v1/tables');
}
// Returns the lines and cities in a box. `east` may be above 180, and then the longitudes of the answer are, too.
export function map(
    { west, south, east, north }: { west: number; south: number; east: number; north: number },
    detail: number,
    kinds: readonly (MapKind | 'city')[],
): Promise<MapAnswer> {
    const side = (degrees: number) => degrees.toFixed(3);
    return told(
        `api/v1/map?west=${side(west)}&south=${side(south)}&east=${side(Math.min(east, west + mostWideDeg))}&north=${side(north)}&detail=${detail}&kinds=${kinds.join()}`,
    );
}

// -- raw volumes

export interface SweepRow {
    sweep: number; // number of the sweep, from 0
    elevation_deg: number;
    start?: string;
    end?: string;
    nyquist_mps?: number;
    waveform?: string; // abbreviation, as "CS"; left out if the volume does not tell its pattern
    moments: { moment: string; chosen?: boolean }[]; // chosen: `stormcellar frame` draws this cut of its elevation
}
export interface VolumeRow {
    vcp?: number | null; // number of the scan pattern
    sweeps: number;
    complete: boolean;
}
const volumesPath = (station: string): string => `api/v1/stations/${encodeURIComponent(station)}/volumes`;

export interface RawVolume {
    time: string | null;
    raw: string | null; // name of the raw file at the server; null: the server does not offer it
    number_in_file: number; // number of the volume in the file
}
// Returns false if the server answers that it does not have the file.
export async function hasRaw(station: string, name: string): Promise<boolean> {
    const { status } = await fetch(rawPath(station, name), { method: 'HEAD' });
    return status !== 404 && status !== 410;
}
// Returns the newest volume of a station that began at a time or before; null if there is none. If the volume has
// several files, returns the last file that the server offers, if any.
export async function rawBefore(station: string, time: string): Promise<RawVolume | null> {
    const { volumes } = await told<{ volumes: RawVolume[] }>(
        `${volumesPath(station)}?to=${encodeURIComponent(time)}&limit=8`,
    );
    const newest = volumes.pop();
    return newest?.raw
        ? newest
        : (volumes.filter((one) => one.time === newest?.time && one.raw).pop() ?? newest ?? null);
}
const sameVolumeMs = 15_000; // the times of a volume's header and of its first radial differ a little
// Returns the volume that began at a time; null if the server has no such volume, or does not offer its file.
export async function rawAt(station: string, time: string): Promise<RawVolume | null> {
    const volume = await rawBefore(station, time);
    return volume?.time && volume.raw && Math.abs(Date.parse(volume.time) - Date.parse(time)) <= sameVolumeMs
        ? volume
        : null;
}
// Returns the volume of a station that began at a time or before, after the volume before it.
export async function volumesUntil(station: string, time: string): Promise<VolumeRow[]> {
    const query = new URLSearchParams({ to: time, limit: '2' });
    return (await told<{ volumes: VolumeRow[] }>(`${volumesPath(station)}?${query}`)).volumes;
}
export interface VolumeAt extends VolumeRow {
    time: string | null;
}
// Returns the volumes of a station that began from `from` to `to`, oldest first; of very many, the newest.
export async function volumesBetween(station: string, from: string, to: string): Promise<VolumeAt[]> {
    const query = new URLSearchParams({ from, to, limit: '1000' });
    return (await told<{ volumes: VolumeAt[] }>(`${volumesPath(station)}?${query}`)).volumes;
}
export async function sweeps(station: string, time: string): Promise<SweepRow[]> {
    return (await told<{ sweeps: SweepRow[] }>(`${volumesPath(station)}/${encodeURIComponent(time)}/sweeps`)).sweeps;
}
// Returns packed gates without echo whose probability of weather is less than `quality`; 0: all echo.
export function gates(
    station: string,
    time: string,
    sweep: number,
    moment: string,
    quality: number,
): Promise<ArrayBuffer> {
    const query = quality > 0 ? `?quality=${quality}` : '';
    return bytesOf(`${volumesPath(station)}/${encodeURIComponent(time)}/sweeps/${sweep}/${moment}${query}`);
}
