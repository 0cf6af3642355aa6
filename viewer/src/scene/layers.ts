// The layers of a view as one value, and as a part of the address.

import { Place } from '../earth/projection';
import { momentFacts } from '../wire/moments';

// Sides of a box in meters: from the middle of the grid, and above sea level.
export interface Crop {
    westM: number;
    eastM: number;
    southM: number;
    northM: number;
    bottomM: number;
    topM: number;
}

export interface Surface {
    value: number; // it encloses what is at least this, or at most (isBelow)
    moment: string; // empty: the one that is shown; of another one, the shown one colors it
}

export interface Layers {
    hasVolume: boolean;
    planeM: number | null; // height of a plane above sea level
    section: readonly [Place, Place] | null;
    surface: Surface | null;
    hasMaximum: boolean; // of each column, on the ground
    sweepDeg: number | null; // elevation of a sweep
    sweepNumber: number | null; // of the volume, if it has it at that elevation; null: the sweep that pictures take
    crop: Crop | null; // of volume and surface
    isLit: boolean;
    hasHaze: boolean; // where no beam saw
    hasFolded: boolean | null; // range folded air; null: as the moment has it
}

// Returns true if the value is a negative velocity, whose surface encloses what is faster toward the radar.
export const isBelow = (moment: string, value: number): boolean => moment === 'VEL' && value < 0;

// Returns true if range folded air is shown. A volume of velocities or their widths shows it by itself, because such
// air is not clear. `moment` is empty while nothing is shown.
export const veilsFolded = ({ hasFolded, hasVolume }: Layers, moment: string): boolean =>
    hasFolded ?? (hasVolume && moment !== '' && momentFacts(moment).isDoppler);

// Returns the opposite choice; null if the moment has it by itself, so that an address stays short.
export function toggledFolded(layers: Layers, moment: string): boolean | null {
    const wanted = !veilsFolded(layers, moment);
    return wanted === veilsFolded({ ...layers, hasFolded: null }, moment) ? null : wanted;
}

export const usualLayers: Layers = {
    hasVolume: true,
    planeM: null,
    section: null,
    surface: null,
    hasMaximum: false,
    sweepDeg: null,
    sweepNumber: null,
    crop: null,
    isLit: false,
    hasHaze: false,
    hasFolded: null,
};

const rounded = (value: number, places: number): string => String(Number(value.toFixed(places)));
const kilometers = (m: number): string => rounded(m / 1000, 3);
const cropSides = ['westM', 'eastM', 'southM', 'northM', 'bottomM', 'topM'] as const;
const farthestM = 2e7;
const mostSweeps = 1000; // of a volume

export const sectionText = (section: readonly [Place, Place]): string =>
    section.flatMap(({ latitudeDeg, longitudeDeg }) => [rounded(latitudeDeg, 5), rounded(longitudeDeg, 5)]).join(',');

// Returns names and texts for the address, without usual values.
export function layersAddress(layers: Layers): [string, string][] {
    const parts: [string, string][] = [];
    if (!layers.hasVolume) parts.push(['volume', '0']);
    if (layers.planeM !== null) parts.push(['height-km', kilometers(layers.planeM)]);
    if (layers.section) parts.push(['section', sectionText(layers.section)]);
    if (layers.surface) {
        parts.push(['surface', rounded(layers.surface.value, 3)]);
        if (layers.surface.moment) parts.push(['surface-moment', layers.surface.moment]);
    }
    if (layers.hasMaximum) parts.push(['maximum', '1']);
    if (layers.sweepDeg !== null) parts.push(['elevation', rounded(layers.sweepDeg, 2)]);
    if (layers.sweepDeg !== null && layers.sweepNumber !== null) parts.push(['sweep', String(layers.sweepNumber)]);
    const { crop } = layers;
    if (crop) parts.push(['crop-km', cropSides.map((side) => kilometers(crop[side])).join(',')]);
    if (layers.isLit) parts.push(['light', 'gradient']);
    if (layers.hasHaze) parts.push(['haze', '1']);
    if (layers.hasFolded !== null) parts.push(['folded', layers.hasFolded ? '1' : '0']);
    return parts;
}

function numbers(text: string | null, count: number, least: number, most: number): number[] | null {
    if (text === null || text === '') return null;
    const found = text.split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
    return found.length === count && found.every((one) => one >= least && one <= most) ? found : null;
}

// Reads two places from "LAT,LON,LAT,LON"; null if the text makes no sense or the places are the same.
export function sectionOf(text: string | null): [Place, Place] | null {
    const found = numbers(text, 4, -360, 360);
    if (!found) return null;
    const [latitudeA, longitudeA, latitudeB, longitudeB] = found as [number, number, number, number];
    const isOnEarth = Math.abs(latitudeA) <= 90 && Math.abs(latitudeB) <= 90;
    if (!isOnEarth || (latitudeA === latitudeB && longitudeA === longitudeB)) return null;
    return [
        { latitudeDeg: latitudeA, longitudeDeg: longitudeA },
        { latitudeDeg: latitudeB, longitudeDeg: longitudeB },
    ];
}

function cropOf(text: string | null): Crop | null {
    const found = numbers(text, 6, -farthestM / 1000, farthestM / 1000);
    if (!found) return null;
    const [westM, eastM, southM, northM, bottomM, topM] = found.map((km) => km * 1000) as [
        number,
        number,
        number,
        number,
        number,
        number,
    ];
    return westM < eastM && southM < northM && bottomM < topM ? { westM, eastM, southM, northM, bottomM, topM } : null;
}

// Reads the layers from the address. A part that makes no sense keeps its usual value.
export function layersOf(query: URLSearchParams): Layers {
    const one = (name: string, least: number, most: number) => numbers(query.get(name), 1, least, most)?.[0] ?? null;
    const planeKm = one('height-km', -1, 100);
    const surface = one('surface', -1000, 1000);
    const sweep = one('sweep', 0, mostSweeps - 1);
    return {
        hasVolume: query.get('volume') !== '0',
        planeM: planeKm === null ? null : planeKm * 1000,
        section: sectionOf(query.get('section')),
        surface:
            surface === null
                ? null
                : { value: surface, moment: (query.get('surface-moment') ?? '').toUpperCase().slice(0, 8) },
        hasMaximum: query.get('maximum') === '1',
        sweepDeg: one('elevation', -5, 90),
        sweepNumber: Number.isInteger(sweep) ? sweep : null,
        crop: cropOf(query.get('crop-km')),
        isLit: query.get('light') === 'gradient',
        hasHaze: query.get('haze') === '1',
        hasFolded: query.get('folded') === '1' ? true : query.get('folded') === '0' ? false : null,
    };
}

// Counts the layers that show echo.
export const echoLayers = ({ hasVolume, planeM, section, surface, hasMaximum, sweepDeg }: Layers): number =>
    [hasVolume, planeM !== null, section, surface, hasMaximum, sweepDeg !== null].filter(Boolean).length;

// Returns what keeps `stormcellar frame` from drawing the layers; null if it can. It draws one layer, which must not be
// a surface, a volume in a box, or a sweep of a mosaic.
export function beyondCommand(
    layers: Layers,
    siteCount: number,
): 'surface' | 'box' | 'several' | 'none' | 'haze' | 'mosaic' | null {
    if (layers.surface) return 'surface';
    if (layers.hasVolume && layers.crop) return 'box';
    if (!layers.hasVolume && (layers.hasHaze || layers.hasFolded === true)) return 'haze';
    const drawn = echoLayers(layers);
    if (drawn !== 1) return drawn === 0 ? 'none' : 'several';
    return layers.sweepDeg !== null && siteCount > 1 ? 'mosaic' : null;
}

// Returns the words with which `stormcellar frame` draws a layer: of several the first one here; null for the volume.
export function productOf(layers: Layers): string[] | null {
    if (layers.hasVolume) return null;
    if (layers.section) return ['--product', 'section', '--section', sectionText(layers.section)];
    if (layers.planeM !== null) return ['--product', 'cappi', '--height-km', kilometers(layers.planeM)];
    if (layers.sweepDeg !== null) {
        const which =
            layers.sweepNumber === null
                ? ['--elevation', rounded(layers.sweepDeg, 2)]
                : ['--sweep', String(layers.sweepNumber)];
        return ['--product', 'ppi', ...which];
    }
    return layers.hasMaximum ? ['--product', 'composite'] : null;
}

// Place of the sun: degrees to the left of the camera, and above the horizon.
export const sunAsideDeg = 65;
export const sunElevationDeg = 40;

// Returns the part of a box that a crop leaves.
export function croppedBox(box: Crop, crop: Crop | null): Crop {
    if (!crop) return box;
    const within = { ...box };
    for (const side of ['westM', 'southM', 'bottomM'] as const) within[side] = Math.max(box[side], crop[side]);
    for (const side of ['eastM', 'northM', 'topM'] as const) within[side] = Math.min(box[side], crop[side]);
    return within;
}
