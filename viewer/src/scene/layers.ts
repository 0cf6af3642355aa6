// Holds the layers of a view, and reads and writes them as parts of the address.

import { Place } from '../earth/projection';
import { CutNumber } from '../fields/sweep_choice';
import { derivedOf, isMoment, momentFacts } from '../wire/moments';

// Sides of a box. Horizontal sides are in meters from the middle of the grid, bottom and top in meters above sea level.
export interface Crop {
    westM: number;
    eastM: number;
    southM: number;
    northM: number;
    bottomM: number;
    topM: number;
}

export interface Surface {
    value: number; // the surface encloses values of at least this, or of at most this if isBelow()
    moment: string; // moment whose values the surface encloses, colored by the shown moment; empty: the shown moment
}

export interface Layers {
    hasVolume: boolean;
    planeM: number | null; // height of a plane above sea level
    section: readonly [Place, Place] | null;
    surface: Surface | null;
    hasMaximum: boolean; // the maxima of columns are on the ground
    sweepDeg: number | null; // elevation of the sweep that is shown
    sweepNumber: CutNumber; // number of the sweep in its volume (see cutOf())
    isSweepDealiased: boolean; // the sweep has dealiased velocities although the shown moment is the measured velocity
    isSweepWeather: boolean; // the sweep lacks echo that is probably not weather
    hasGlyphs: boolean; // the sweep of a velocity has beam glyphs
    hasRotation: boolean; // columns of strong azimuthal shear are drawn
    hasCells: boolean; // storm cells are marked and listed
    crop: Crop | null; // box to which volume and surface are cut
    isLit: boolean;
    hasHaze: boolean; // air that no beam saw is veiled
    hasFolded: boolean | null; // range folded air is veiled; null: see veilsFolded()
}

// The moment whose strong values are drawn as rotation, and their least strength in its unit, 0.001/s. Where the values
// are above zero, rotation is counterclockwise. page/rotation.ts says what the share is.
export const rotationMoment = 'AZSH';
export const leastRotation = 8;
export const columnShare = 0.22;

// Returns true if the value is a negative velocity. Its surface encloses faster velocities toward the radar.
export const isBelow = (moment: string, value: number): boolean =>
    value < 0 && isMoment(moment) && momentFacts(moment).isSigned;

// Returns the moment of the sweep while a moment is shown.
export const sweepMoment = ({ isSweepDealiased }: Layers, moment: string): string =>
    (isSweepDealiased ? derivedOf(moment) : null) ?? moment;

// Returns the least probability of weather of the sweep's echo; 0: all echo.
export const sweepQuality = ({ isSweepWeather }: Layers): number => (isSweepWeather ? 0.5 : 0);

// Returns true if range folded air is veiled. If the user has not chosen, a volume of velocities or spectrum widths
// veils it, because such air is not clear. `moment` is empty while nothing is shown.
export const veilsFolded = ({ hasFolded, hasVolume }: Layers, moment: string): boolean =>
    hasFolded ?? (hasVolume && moment !== '' && momentFacts(moment).isDoppler);

// Returns the value of `hasFolded` that turns the veil on or off; null if the moment's usual veil already is as wanted,
// which keeps the address short.
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
    isSweepDealiased: false,
    isSweepWeather: false,
    hasGlyphs: false,
    hasRotation: false,
    hasCells: false,
    crop: null,
    isLit: false,
    hasHaze: false,
    hasFolded: null,
};

// The sweep nearest to this elevation is shown first.
export const lowestTiltDeg = 0.5;

// Returns the layers of a flat map (2D): one sweep, with the marks that the user has chosen for it.
export const flatLayers = (layers: Layers): Layers => ({
    ...usualLayers,
    hasVolume: false,
    sweepDeg: layers.sweepDeg ?? lowestTiltDeg,
    sweepNumber: layers.sweepNumber,
    isSweepDealiased: layers.isSweepDealiased,
    isSweepWeather: layers.isSweepWeather,
    hasGlyphs: layers.hasGlyphs,
    hasCells: layers.hasCells,
});

const rounded = (value: number, places: number): string => String(Number(value.toFixed(places)));
const kilometers = (m: number): string => rounded(m / 1000, 3);
const cropSides = ['westM', 'eastM', 'southM', 'northM', 'bottomM', 'topM'] as const;
const farthestM = 2e7;
const mostSweeps = 1000; // of a volume

export const sectionText = (section: readonly [Place, Place]): string =>
    section.flatMap(({ latitudeDeg, longitudeDeg }) => [rounded(latitudeDeg, 5), rounded(longitudeDeg, 5)]).join(',');

// Returns the parameters of the address, except those with usual values.
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
    if (layers.sweepDeg !== null && layers.isSweepDealiased) parts.push(['dealiased', '1']);
    if (layers.sweepDeg !== null && layers.isSweepWeather) parts.push(['weather', '1']);
    if (layers.hasGlyphs) parts.push(['glyphs', '1']);
    if (layers.hasRotation) parts.push(['rotation', '1']);
    if (layers.hasCells) parts.push(['cells', '1']);
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
        sweepNumber: query.get('sweep') === 'first' ? 'first' : Number.isInteger(sweep) ? sweep : null,
        isSweepDealiased: query.get('dealiased') === '1',
        isSweepWeather: query.get('weather') === '1',
        hasGlyphs: query.get('glyphs') === '1',
        hasRotation: query.get('rotation') === '1',
        hasCells: query.get('cells') === '1',
        crop: cropOf(query.get('crop-km')),
        isLit: query.get('light') === 'gradient',
        hasHaze: query.get('haze') === '1',
        hasFolded: query.get('folded') === '1' ? true : query.get('folded') === '0' ? false : null,
    };
}

export const echoLayers = ({
    hasVolume,
    planeM,
    section,
    surface,
    hasMaximum,
    sweepDeg,
    hasRotation,
}: Layers): number =>
    [hasVolume, planeM !== null, section, surface, hasMaximum, sweepDeg !== null, hasRotation].filter(Boolean).length;

// Returns the reason why `stormcellar frame` cannot draw the layers; null if it can. The command draws exactly one
// layer. It refuses a surface, a volume in a box, a sweep of a mosaic, and veils of haze or of range folded air without
// a volume.
export function beyondCommand(
    layers: Layers,
    siteCount: number,
): 'surface' | 'box' | 'several' | 'none' | 'haze' | 'mosaic' | null {
    if (layers.surface || (layers.hasRotation && !layers.hasVolume)) return 'surface';
    if (layers.hasVolume && layers.crop) return 'box';
    if (!layers.hasVolume && (layers.hasHaze || layers.hasFolded === true)) return 'haze';
    const drawn = echoLayers({ ...layers, hasRotation: false });
    if (drawn !== 1) return drawn === 0 ? 'none' : 'several';
    return layers.sweepDeg !== null && siteCount > 1 ? 'mosaic' : null;
}

// Returns the arguments of `stormcellar frame` for the first of section, plane, sweep and maximum that is on; null if
// the volume is on or none of these layers is on.
export function productOf(layers: Layers): string[] | null {
    if (layers.hasVolume) return null;
    if (layers.section) return ['--product', 'section', '--section', sectionText(layers.section)];
    if (layers.planeM !== null) return ['--product', 'cappi', '--height-km', kilometers(layers.planeM)];
    if (layers.sweepDeg !== null) {
        const which =
            typeof layers.sweepNumber === 'number'
                ? ['--sweep', String(layers.sweepNumber)]
                : ['--elevation', rounded(layers.sweepDeg, 2)];
        const quality = sweepQuality(layers);
        return ['--product', 'ppi', ...which, ...(quality > 0 ? ['--quality', String(quality)] : [])];
    }
    return layers.hasMaximum ? ['--product', 'composite'] : null;
}

// Direction of the sun: degrees to the left of the camera, and degrees above the horizon.
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
