// Lists the stations on the start map, and finds a station by pointer, by key or by name.

import { City, Station } from '../wire/api';
import { Place, geodesic } from '../earth/projection';

export interface StationPlace extends Place {
    icao: string;
    name: string; // name of the town, with its state
    newest: string | null; // time of the newest grid, else of the newest volume; null without both
    ageS: number | null; // its age
    hasGrids: boolean;
    moments: string[];
    newestGrid: string | null; // time of the newest grid
}

// Returns the stations whose position is known. Stations without a position are only in the list of domains.
export function stationPlaces(stations: Station[]): StationPlace[] {
    return stations.flatMap((one) => {
        const { latitude_deg: latitudeDeg, longitude_deg: longitudeDeg } = one;
        if (latitudeDeg === undefined || longitudeDeg === undefined) return [];
        return [
            {
                icao: one.station,
                name: [one.name, one.state].filter(Boolean).join(', '),
                latitudeDeg,
                longitudeDeg,
                newest: (one.newest_grid ?? one.newest_volume)?.time ?? null,
                ageS: (one.newest_grid ?? one.newest_volume)?.age_s ?? null,
                hasGrids: one.moments.length > 0,
                moments: one.moments,
                newestGrid: one.newest_grid?.time ?? null,
            },
        ];
    });
}

export type Pixel = [number, number];

// Returns the index of the pixel nearest to (x, y); -1 if none is within reach.
export function nearestPixel(pixels: Pixel[], x: number, y: number, reach: number): number {
    let best = -1;
    let least = reach;
    pixels.forEach(([px, py], i) => {
        const distance = Math.hypot(px - x, py - y);
        if (distance <= least) {
            least = distance;
            best = i;
        }
    });
    return best;
}

// Returns the index of the pixel that an arrow key leads to; -1 if none is in its direction. Prefers pixels that are
// near `from` and close to the line in the key's direction.
export function pixelToward(pixels: Pixel[], from: Pixel, [wx, wy]: Pixel): number {
    let best = -1;
    let least = Infinity;
    pixels.forEach(([px, py], i) => {
        const ahead = (px - from[0]) * wx + (py - from[1]) * wy;
        const aside = Math.abs((px - from[0]) * wy - (py - from[1]) * wx);
        if (ahead <= 0.5 || aside > 1.5 * ahead) return;
        const cost = ahead + 2 * aside;
        if (cost < least) {
            least = cost;
            best = i;
        }
    });
    return best;
}

export function isInside(polygon: Pixel[], x: number, y: number): boolean {
    let inside = false;
    for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
        const [[ax, ay], [bx, by]] = [polygon[i]!, polygon[j]!];
        if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
    }
    return inside;
}

export interface Found {
    station: StationPlace;
    near: string | null; // name of the city that the search found; null: the search found the station itself
    distanceM: number; // from that city; 0 without a city
}

const stationsOfACity = 3;
const mostAwayM = 460_000; // radars do not see farther
const mostCities = 4;

const simple = (text: string): string =>
    text
        .normalize('NFD')
        .replace(/[\u0300-\u036f]/g, '')
        .toLowerCase()
        .trim();

// Reads latitude and longitude in degrees, as in "35.3, -97.5"; null if the text is something else.
function coordinatesIn(text: string): Place | null {
    const found = /^\s*(-?\d+(?:\.\d+)?)\s*[,\s]\s*(-?\d+(?:\.\d+)?)\s*$/.exec(text);
    const [latitudeDeg, longitudeDeg] = [Number(found?.[1]), Number(found?.[2])];
    return Math.abs(latitudeDeg) <= 90 && Math.abs(longitudeDeg) <= 180 ? { latitudeDeg, longitudeDeg } : null;
}

// Finds stations by ICAO or name, and then the nearest stations to cities whose name begins with the text, or to the
// coordinates in the text. An empty text finds all stations.
export function search(stations: StationPlace[], cities: City[], text: string): Found[] {
    const wanted = simple(text);
    const own = (station: StationPlace): Found => ({ station, near: null, distanceM: 0 });
    if (wanted === '') return stations.map(own);
    const rank = ({ icao, name }: StationPlace): number => {
        if (simple(icao) === wanted || simple(icao) === `k${wanted}`) return 0;
        if (simple(icao).startsWith(wanted)) return 1;
        if (simple(name).startsWith(wanted)) return 2;
        return simple(name).includes(wanted) || simple(icao).includes(wanted) ? 3 : 4;
    };
    const named = stations
        .map((station) => ({ station, rank: rank(station) }))
        .filter((one) => one.rank < 4)
        .sort((a, b) => a.rank - b.rank)
        .map(({ station }) => own(station));
    const found = new Map(named.map((one) => [one.station.icao, one]));
    const coordinates = coordinatesIn(text);
    const ofThisName = cities
        .filter((city) => simple(city.name).startsWith(wanted))
        .slice(0, mostCities)
        .map(({ name, place: [longitudeDeg, latitudeDeg] }) => ({ name, place: { latitudeDeg, longitudeDeg } }));
    for (const { name, place } of coordinates ? [{ name: text.trim(), place: coordinates }] : ofThisName) {
        stations
            .map((station) => ({ station, near: name, distanceM: geodesic(place, station).distanceM }))
            .filter(({ distanceM }) => distanceM <= mostAwayM)
            .sort((a, b) => a.distanceM - b.distanceM)
            .slice(0, stationsOfACity)
            .forEach((one) => {
                if (!found.has(one.station.icao)) found.set(one.station.icao, one);
            });
    }
    return [...found.values()];
}
