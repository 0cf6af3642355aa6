// Holds the view of the page, and reads and writes it as the text after # in the address.

import { namedView } from '../camera/controls';
import { Camera, usualCamera } from '../camera/geometry';
import { geodesic } from '../earth/projection';
import { moments, ranges, usualGrid } from '../facts';
import { Draft } from '../tables/draft';
import { draftOfText, textOfDraft } from '../tables/draft_text';
import { isVelocity } from '../wire/moments';
import { PackedGrid } from '../wire/packed_grid';
import { Units, namesOf, unitsOf, usualUnits } from '../tables/units';
import { PaneView, Panes, allPanes, paneText, panesOfQuery } from './panes';
import { quoted } from './shell';
import { layersAddress, productOf, sunAsideDeg, sunElevationDeg, sweepMoment, usualLayers } from './layers';

// The moment, layers, `least` and `colors` are those of the active pane.
export interface ViewState extends Panes {
    domain: string; // empty: the first domain
    time: string; // ISO 8601, or 'latest'
    betweenS: number; // seconds between frames that are made between volumes; 0: no such frames
    isFlat: boolean; // 2D: the camera is that of a map, and stays so
    camera: Camera;
    hasGround: boolean; // map and ground are drawn
    exaggeration: number;
    opacity: number;
    quality: string; // name of a way of drawing (renderer/ladder.ts); empty: the page chooses one
    memoryMib: number; // memory for grids; a change takes effect when the page is opened again
    countsFetches: boolean; // the page counts the texels that a pixel asks for
    drafts: Draft[]; // tables that the user made, at most one for each moment; they override `colors`
    overlays: readonly string[]; // names of the server's overlays that are on
    units: Units;
}

export const usualState: ViewState = {
    domain: '',
    moment: '',
    time: 'latest',
    betweenS: 0,
    isFlat: false,
    camera: { ...usualCamera, tiltDeg: 60, fieldOfViewDeg: 40 },
    hasGround: true,
    exaggeration: 5,
    opacity: 1,
    least: null,
    colors: '',
    quality: '',
    memoryMib: 256,
    countsFetches: false,
    drafts: [],
    layers: usualLayers,
    panes: [],
    active: 0,
    overlays: [],
    units: usualUnits,
};

const mostDrafts = Object.keys(moments).length;
const mostOverlays = 20;

const rounded = (value: number, places: number): string => String(Number(value.toFixed(places)));

export function addressOf(state: ViewState): string {
    const { camera } = state;
    const [first, ...others] = allPanes(state) as [PaneView, ...PaneView[]];
    const parts: [string, string][] = [
        ['domain', state.domain],
        ['moment', first.moment],
        ['time', state.time],
        ['azimuth', rounded(camera.azimuthDeg, 2)],
        ['tilt', rounded(camera.tiltDeg, 2)],
        ['zoom', rounded(camera.zoom, 4)],
        ['field-of-view', rounded(camera.fieldOfViewDeg, 2)],
        ['exaggeration', rounded(state.exaggeration, 2)],
        ['opacity', rounded(state.opacity, 3)],
    ];
    if (camera.lookAtM) {
        parts.push(['look-at-km', camera.lookAtM.map((m) => rounded(m / 1000, 3)).join(',')]);
    }
    if (state.isFlat) parts.push(['view', '2d']);
    if (state.betweenS > 0) parts.push(['between', rounded(state.betweenS, 0)]);
    if (!state.hasGround) parts.push(['ground', '0']);
    if (first.least !== null) parts.push(['least', rounded(first.least, 4)]);
    if (first.colors) parts.push(['colors', first.colors]);
    if (state.quality) parts.push(['quality', state.quality]);
    if (state.memoryMib !== usualState.memoryMib) parts.push(['memory', String(state.memoryMib)]);
    if (state.countsFetches) parts.push(['count-fetches', '1']);
    for (const draft of state.drafts) parts.push(['table', textOfDraft(draft)]);
    parts.push(...layersAddress(first.layers));
    for (const name of state.overlays) parts.push(['overlay', name]);
    if (state.isFlat && first.layers.hasVolume) parts.push(['volume', '1']);
    if (namesOf(state.units)) parts.push(['units', namesOf(state.units)]);
    for (const pane of others) parts.push(['pane', paneText(pane, state.isFlat)]);
    if (state.active > 0) parts.push(['active', String(state.active + 1)]);
    const readable = (text: string) => encodeURIComponent(text).replace(/%(3B|3D|2C)/g, decodeURIComponent);
    return parts
        .map(([name, text]) => `${name}=${name === 'pane' ? readable(text) : encodeURIComponent(text)}`)
        .join('&');
}

// Reads the first `mostDrafts` words, and returns the last draft of each moment. Ignores words that make no sense.
function draftsOf(words: string[]): Draft[] {
    const drafts = new Map<string, Draft>();
    for (const word of words.slice(0, mostDrafts)) {
        const draft = draftOfText(word);
        if (draft) drafts.set(draft.moment, draft);
    }
    return [...drafts.values()];
}

interface Range {
    least: number;
    most: number;
}

function number(text: string | null, { least, most }: Range, otherwise: number): number {
    const value = text === null || text === '' ? NaN : Number(text);
    return value >= least && value <= most ? value : otherwise;
}

// Returns the time as ISO 8601, where a time of day without a zone is UTC; 'latest' if the text is not a time.
function timeOf(text: string): string {
    const hasZone = /(Z|[+-]\d\d:?\d\d)$/i.test(text) && text.includes(':');
    const time = hasZone || !text.includes(':') ? text : `${text}Z`;
    return Number.isNaN(Date.parse(time)) ? 'latest' : time;
}

function cameraOf(query: URLSearchParams): Camera {
    const usual = usualState.camera;
    const lookAt = (query.get('look-at-km') ?? '').split(',').map(Number);
    return {
        azimuthDeg: number(query.get('azimuth'), { least: 0, most: 360 }, usual.azimuthDeg),
        tiltDeg: number(query.get('tilt'), ranges.tiltDeg, usual.tiltDeg),
        zoom: number(query.get('zoom'), ranges.zoom, usual.zoom),
        fieldOfViewDeg: number(
            query.get('field-of-view'),
            { ...ranges.fieldOfViewDeg, least: 0 },
            usual.fieldOfViewDeg,
        ),
        lookAtM:
            lookAt.length === 3 && lookAt.every(Number.isFinite)
                ? [lookAt[0]! * 1000, lookAt[1]! * 1000, lookAt[2]! * 1000]
                : null,
    };
}

// Reads the view from the text. A parameter that makes no sense keeps its usual value.
export function stateOf(text: string): ViewState {
    const query = new URLSearchParams(text.replace(/^#/, ''));
    const usual = usualState;
    const isFlat = query.get('view') === '2d';
    return {
        domain: (query.get('domain') ?? '').slice(0, 100),
        time: timeOf(query.get('time') ?? ''),
        betweenS: number(query.get('between'), { least: 10, most: 3600 }, 0),
        isFlat,
        camera: isFlat ? namedView(cameraOf(query), 'top') : cameraOf(query),
        hasGround: query.get('ground') !== '0',
        exaggeration: number(query.get('exaggeration'), ranges.exaggeration, usual.exaggeration),
        opacity: number(query.get('opacity'), ranges.opacity, usual.opacity),
        quality: (query.get('quality') ?? '').slice(0, 100),
        memoryMib: number(query.get('memory'), { least: 4, most: 4096 }, usual.memoryMib),
        countsFetches: query.get('count-fetches') === '1',
        drafts: draftsOf(query.getAll('table')),
        ...panesOfQuery(query, isFlat),
        overlays: [...new Set(query.getAll('overlay'))].filter((name) => name !== '').slice(0, mostOverlays),
        units: unitsOf(query.get('units') ?? ''),
    };
}

const isWithin = (value: number, { least, most }: Range): boolean => value >= least && value <= most;

// Returns true if a number of the view is outside of the range that `stormcellar frame` takes.
export function isBeyondLimits({ camera, layers }: ViewState, width: number, height: number): boolean {
    if (![width, height].every((side) => isWithin(side, ranges.sidePx))) return true;
    if (layers.hasVolume) return camera.fieldOfViewDeg > 0 && !isWithin(camera.fieldOfViewDeg, ranges.fieldOfViewDeg);
    if (layers.planeM !== null && !isWithin(layers.planeM, ranges.planeM)) return true;
    if (!layers.section) return false;
    const { distanceM } = geodesic(layers.section[0], layers.section[1]);
    return !isWithin(distanceM / 1000, ranges.sectionKm);
}

function cameraWords({ camera, exaggeration, opacity, layers }: ViewState): string[] {
    const words = [
        '--azimuth',
        rounded(camera.azimuthDeg, 2),
        '--tilt',
        rounded(camera.tiltDeg, 2),
        '--zoom',
        rounded(camera.zoom, 4),
    ];
    words.push('--field-of-view', rounded(camera.fieldOfViewDeg, 2), '--exaggeration', rounded(exaggeration, 2));
    words.push('--opacity', rounded(opacity, 3), '--light', layers.isLit ? 'gradient' : 'none');
    if (layers.isLit) words.push('--sun', `${rounded((camera.azimuthDeg + sunAsideDeg) % 360, 2)},${sunElevationDeg}`);
    if (layers.hasHaze) words.push('--haze');
    if (camera.lookAtM) words.push('--look-at-km', camera.lookAtM.map((m) => rounded(m / 1000, 3)).join(','));
    return words;
}

// Returns true for the grid that `stormcellar frame` makes of a raw file.
export function isUsualGrid({
    nx,
    ny,
    spacing,
    levelsM,
}: Pick<PackedGrid, 'nx' | 'ny' | 'spacing' | 'levelsM'>): boolean {
    return (
        nx === usualGrid.nx &&
        ny === usualGrid.ny &&
        spacing === usualGrid.spacingM &&
        levelsM.length === usualGrid.levels &&
        levelsM.every((m, level) => m === usualGrid.betweenLevelsM * (level + 1))
    );
}

// Returns the command that draws the view; if several layers are on, the command draws one of them. `colors` is a table
// or a file; if it is empty, the command uses the moment's own colors. `file` is a raw file to draw instead of the
// domain's grid, and `volume` the number of the volume in that file.
export function commandOf(
    state: ViewState,
    width: number,
    height: number,
    colors: string,
    file = '',
    volume = 1,
): string {
    const product = productOf(state.layers);
    const moment = product?.includes('ppi') ? sweepMoment(state.layers, state.moment) : state.moment;
    // Put "./" before a name that begins with a dash, because it would be read as an option.
    const words = ['stormcellar', 'frame', (file || state.domain).replace(/^-/, './-'), '--moment', moment];
    if (state.time !== 'latest' && !file) words.push('--time', state.time);
    if (file && volume > 1) words.push('--volume', String(volume));
    words.push(...(product ?? cameraWords(state)));
    if (!product && state.layers.hasRotation) words.push('--rotation');
    if (product?.includes('ppi') && state.layers.hasGlyphs && isVelocity(moment)) words.push('--glyphs');
    if (state.layers.hasCells && !product?.includes('section')) words.push('--overlay', 'cells');
    if (colors) words.push('--colors', colors);
    if (namesOf(state.units)) words.push('--units', namesOf(state.units));
    words.push('--width', String(width), '--height', String(height), '-o', `${state.domain}.png`);
    return words.map(quoted).join(' ');
}
