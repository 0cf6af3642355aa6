// Has every text of the page, so that it can be translated.

import { isAhead } from '../time/timeline';
import { CellState, LeftOutEcho } from '../wire/packed_grid';

function span(seconds: number): string {
    const [minutes, hours, days] = [seconds / 60, seconds / 3600, seconds / 86400];
    if (minutes < 90) return `${Math.max(0, Math.round(minutes))} min`;
    if (hours < 48) return `${Math.round(hours)} h`;
    return days < 730 ? `${Math.round(days)} days` : `${Math.round(days / 365.25)} years`;
}
const age = (seconds: number): string => (isAhead(seconds) ? 'in the future' : `${span(seconds)} ago`);

// Tells how long before or after an instant the volumes of a site were.
function ofVolumes(middlesS: number[]): string {
    const away = (seconds: number) =>
        Math.abs(seconds) < 90 ? `${Math.round(Math.abs(seconds))} s` : `${Math.round(Math.abs(seconds) / 60)} min`;
    const told = middlesS.map((seconds) => (seconds < 0 ? `${away(seconds)} before` : `${away(seconds)} after`));
    if (middlesS.length > 1) return `from volumes ${told.join(' and ')}`;
    return Math.abs(middlesS[0] ?? 0) < 1 ? 'as it was' : `as it was ${told[0]}`;
}
const mostSitesTold = 3;
function sitesAt(sites: { site: string; middlesS: number[] }[]): string {
    const told = (some: typeof sites) => some.map(({ site, middlesS }) => `${site} ${ofVolumes(middlesS)}`).join('; ');
    if (sites.length <= mostSitesTold) return told(sites);
    const alone = sites.filter(({ middlesS }) => middlesS.length === 1);
    const asTheyWere = told(alone)
        .replace(/ as it was/g, '')
        .replace(/;/g, ',');
    const moved = sites.filter(({ middlesS }) => middlesS.length > 1);
    const farthest = Math.max(...moved.flatMap(({ middlesS }) => middlesS.map(Math.abs)));
    const all =
        moved.length > 0 ? `${moved.length} sites from volumes at most ${Math.ceil(farthest / 60)} min away` : '';
    return [all, alone.length > 0 ? `as they were: ${asTheyWere}` : ''].filter(Boolean).join('; ');
}

// Names the sites that are left out, grouped by the server's reason. A reason begins with "it" or "its".
function leftOut(sites: [string, string][]): string {
    const reasons = [...new Set(sites.map(([, reason]) => reason))].map((reason) => {
        const names = sites.filter((one) => one[1] === reason).map(([site]) => site);
        const told = names.length === 1 ? reason : reason.replace(/^it has /, 'they have ').replace(/^its /, 'their ');
        return names.join(', ') + (told && ` (${told})`);
    });
    return `not in the picture: ${reasons.join(', ')}`;
}

const greatestOf = (halvings: number): string => `greatest of ${2 ** halvings} x ${2 ** halvings} cells`;

export const texts = {
    title: 'stormcellar',
    loading: 'Loading',
    drawing: 'Drawing',
    noGrids: 'There are no grids yet. The page shows the first one as soon as it is there.',
    noWebgl: 'This browser has no WebGL 2, which the view needs.',
    notFound: 'There is no picture of this domain, moment and time.',
    notice: {
        noServer: 'The server does not answer. Trying again …',
        noGraphics: 'The graphics processor was lost: nothing is drawn. If it does not come back, reload the page.',
        reload: 'Reload',
        silent: (station: string, ageS: number) => `${station} is silent: nothing came for ${span(ageS)}.`,
        noDomain: (domain: string) => `No data for ${domain}. Choose another radar.`,
        otherDomain: (domain: string, shown: string) => `No data for ${domain}. This is ${shown}.`,
        otherMoment: (domain: string, moment: string, shown: string) => `${domain} has no ${moment}. This is ${shown}.`,
        noTime: (text: string) => `${text} is not a time. This is the newest volume.`,
        otherTime: (time: string) =>
            `No volume at ${new Date(time).toISOString().slice(0, 19).replace('T', ' ')} UTC. This is the nearest one.`,
    },
    failed: (what: string) => `This did not work: ${what}`,
    domain: 'Domain',
    moment: 'Moment',
    dealiased: 'Dealiased',
    noDealiased: (moment: string) =>
        `The server has no grids of ${moment} here. The layer "Sweep in its place" can show dealiased sweeps.`,
    time: 'Time',
    latest: 'Newest',
    live: 'Live',
    settings: 'Settings',
    play: 'Play',
    pause: 'Pause',
    earlier: 'Earlier volume',
    later: 'Later volume',
    speed: 'Frames a second',
    loopFrom: 'Loop from here',
    loopTo: 'Loop to here',
    loopAll: 'Loop over all',
    between: 'In between',
    betweenOff: 'none',
    betweenEvery: (seconds: number) => (seconds < 60 ? `every ${seconds} s` : `every ${seconds / 60} min`),
    isBetween: 'made between volumes',
    waiting: (time: string) => `Waiting for ${time}`,
    editColors: 'Edit colors and opacity',
    safeTable: (name: string) => `${name} (for every color vision)`,
    threshold: 'Hide values below',
    nothingHidden: 'nothing is hidden',
    opacity: 'Opacity',
    exaggeration: 'Heights times',
    colors: 'Colors',
    perspective: 'Perspective',
    views: 'View',
    top: 'Top',
    northUp: 'North up',
    south: 'South',
    oblique: 'Oblique',
    share: 'Copy link',
    shared: 'The link is in the clipboard.',
    copyByHand: 'The clipboard is not available. Copy the text below.',
    save: 'Save picture',
    saving: 'Saving the picture',
    notSaved: 'The picture was not saved, because it did not load completely. Try again.',
    command: 'Copy command',
    commandCopied: 'The command is in the clipboard.',
    commandReads: (raw: string) => `It reads ${raw}. Raw volume downloads that file.`,
    commandReadsCache: 'It reads the cache of this server.',
    commandColors: (name: string) => `Its colors are in ${name}, which the page saved.`,
    commandFlat: 'It draws the layer as a map of the grid.',
    noCommand: {
        nothing: 'There is no picture yet.',
        coming: 'The picture is not complete yet.',
        region: 'No command draws a merged region.',
        name: 'The name of this domain has characters that a terminal obeys.',
        between: 'No command draws an interpolated frame.',
        ground: 'No command draws echo without the ground.',
        surface: 'No command draws a surface. Hide it to copy one.',
        box: 'No command cuts the volume to a box. Remove the box to copy one.',
        haze: 'No command draws haze or the veil without the volume.',
        mosaic: 'No command draws a sweep of a mosaic. Choose its radar to copy one.',
        noSweep: 'No sweep is shown.',
        veil: 'No command draws the veil of range-folded air. Switch it off to copy one.',
        limits: 'No command draws this view: its perspective, height, section or size is beyond the limits.',
        several: 'A command draws one layer. Hide the others to copy one.',
        none: 'No layer is shown.',
    },
    netcdf: 'Grid (netCDF)',
    noNetcdf: 'A merged region or an interpolated frame cannot be downloaded as netCDF.',
    close: 'Close',
    help: 'Keys',
    helpText: [
        'Drag to turn, with Shift or the right button to move, wheel or pinch to zoom. On the map it is the other way round.',
        'Arrow keys turn, with Shift they move (on the map the other way round); + and - zoom.',
        'T map with north up, S from the south, O oblique, P perspective.',
        'Space plays, comma and period step, L follows the newest; < and > begin and end a loop.',
        'E edits colors and opacity: there, arrows move a point, page keys choose the next, Insert adds one, Delete removes it.',
        'V volume, C plane with [ and ] for its height, X section, A looks at it, I surface, M column maximum, W sweep, J its beam glyphs, K rotation, Y storm cells, B box.',
        'G light, N haze where no beam saw, U veil where range folded.',
        'Click a place to read the column above it.',
        'Ambiguous: echo whose velocity cannot be dealiased for sure; hatched, and not in the volume.',
        'D measures a distance, R an area, F flies: W A S D, E and Q, arrows; Escape ends each.',
        'H goes home, to the map of all stations.',
    ],
    notSeen: 'not seen',
    noEcho: 'no echo',
    rangeFolded: 'range folded',
    ambiguous: 'ambiguous',
    ambiguousTold: 'echo whose velocity cannot be dealiased for sure',
    greatestAt: (value: string, height: string) => `Maximum ${value} at ${height} above sea level`,
    place: (latitudeDeg: number, longitudeDeg: number) =>
        `${Math.abs(latitudeDeg).toFixed(3)} ${latitudeDeg < 0 ? 'S' : 'N'}, ${Math.abs(longitudeDeg).toFixed(3)} ${longitudeDeg < 0 ? 'W' : 'E'}`,
    column: 'The column there:',
    seenBetween: (from: string, to: string) => `seen ${from} – ${to} above sea level`,
    units: { all: 'Units', speed: 'Speeds', distance: 'Distances', height: 'Heights' },
    legend: {
        name: 'What the shades mean',
        aloft: 'seen only > 3 km',
        heights: (times: number) => `heights\u00a0×\u00a0${times}`,
    },
    partial: 'Partial volume',
    quality: 'Exactness',
    asTimeAllows: 'as time allows',
    rung: (name: string, dE: number) => `${name}: dE ${dE}`,
    held: (bytes: number, most: number) => `Grids take ${Math.round(bytes / 2 ** 20)} of ${most / 2 ** 20} MiB`,
    surfaceLeftOut: 'not shown: this grid is too large for the surface of another moment',
    detailOfLayers: (halvings: number) => (halvings > 0 ? `layers: ${greatestOf(halvings)}` : ''),
    detail: ({ coarsest, missing, isGone }: { coarsest: number; missing: number; isGone: boolean }) => {
        const cells = coarsest > 0 ? greatestOf(coarsest) : '';
        return missing > 0 ? `coarse: ${cells}, finer ones are ${isGone ? 'gone' : 'loading'}` : cells;
    },
    drawn: (ms: number, how: { name: string; dE: number }, fetches: number | null) =>
        `${ms} ms, dE ${how.dE} (${how.name}${fetches === null ? '' : `, ${fetches.toFixed(1)} texels a pixel`})`,
    layers: {
        title: 'Layers',
        volume: 'Volume',
        plane: 'Plane at a height',
        section: 'Vertical section',
        surface: 'Surface of a value',
        maximum: 'Column maximum on the ground',
        maximumTold: 'column maximum',
        sweep: 'Sweep in its place',
        glyphs: 'Beam glyphs on a sweep of velocity',
        glyphAlong: (speed: string) => `${speed} along the beam`,
        glyphAcross: 'wind across the beam: not observed',
        rotation: 'Rotation',
        cells: 'Storm cells',
        rotationTold: (least: number) => `rotation: azimuthal shear of ${least / 1000}/s or more, 2 km deep or more`,
        turning: ['cyclonic', 'anticyclonic'],
        crop: 'Box',
        light: 'Light',
        haze: 'Haze where no beam saw',
        folded: 'Veil where range folded',
        draw: 'Draw on the ground',
        across: 'Across the view',
        lookAt: 'Look at it',
        ends: 'From and to (latitude, longitude)',
        encloses: 'Encloses values from',
        enclosesBelow: 'Encloses values to',
        surfaceOf: 'Of',
        elevation: 'Cut (angle, UTC)',
        sides: { westM: 'West', eastM: 'East', southM: 'South', northM: 'North', bottomM: 'Bottom', topM: 'Top' },
        dragSection: 'Drag on the ground from A to B. Escape ends this.',
        dragCrop: 'Drag on the ground from corner to corner. Escape ends this.',
        plot: 'Vertical section: distance from A to B, and height. Arrow keys read it.',
        told: (what: string, distance: string, height: string) =>
            `${what}, ${distance} from A, ${height} above sea level`,
        greatest: (told: string) => `Greatest ${told}`,
        nothing: 'The section has no echo.',
        nothingButFolded: 'The section has range-folded air, but no echo.',
        nothingButAmbiguous: 'The section has only ambiguous echo, which has no value.',
        hidden: 'echo is hidden',
        hiddenOutside: (bottom: string, top: string) => `echo outside the box from ${bottom} to ${top} is hidden`,
        hiddenFolded: 'range-folded air is hidden',
        fainter: (opacity: number) => `opacity × ${opacity}`,
        hiddenBelow: (value: string) => `values below ${value} are hidden`,
        noEchoFrom: (value: string) => `no echo of ${value} or more`,
        planeAt: (height: string) => `${height} above sea level`,
        planeTold: (height: string) => `plane at ${height}`,
        surfaceFrom: (moment: string, value: string) => `surface of ${moment} from ${value}`,
        surfaceBelow: (moment: string, value: string) => `surface of ${moment} to ${value}`,
        sweepAt: (station: string, cut: string) => `sweep of ${station}: ${cut}`,
        dealiasedSweepAt: (station: string, cut: string) => `sweep of ${station}, dealiased: ${cut}`,
        dealiasSweep: 'Dealiased',
        weatherSweep: 'Weather only',
        leftOut: (before: string, echo: LeftOutEcho | null) =>
            echo === null
                ? ''
                : `${before}weather only` +
                  (echo.share >= 0 ? `: ${Math.round(100 * echo.share)} % of the echo left out` : ''),
        sweepComes: (station: string) => `loading the sweep of ${station}`,
        sweepFailed: (station: string) => `the sweep of ${station} could not be loaded`,
        noSweep: (station: string) => `no sweep of ${station} for this time`,
        cut: (elevation: string, time: string, kind: string) => [`${elevation}°`, time, kind].filter(Boolean).join(' '),
        kinds: { surveillance: 'long range', doppler: 'Doppler' },
        beyond: 'beyond the grid',
        otherCells: 'not shown: its grid has other cells',
        otherComes: 'loading',
        noOther: (moment: string) => `not shown: no ${moment} for this time`,
        otherFailed: (moment: string) => `not shown: ${moment} could not be loaded`,
        noVolume: (station: string) => `There is no raw volume of ${station} for this time.`,
    },
    hover: {
        value: (value: string, height: string) => `${value} at ${height}`,
        beam: (elevation: string, width: string, range: string, azimuthDeg: number, icao: string) =>
            `tilt ${elevation}°, beam ${width} wide, ${range} at ${Math.round(azimuthDeg) % 360}° from ${icao}`,
        from: (range: string, azimuthDeg: number, icao: string) =>
            `${range} at ${Math.round(azimuthDeg + 360) % 360}° from ${icao}`,
        time: (time: string) => `seen at ${time} UTC`,
        error: (error: string) => `grid differs from the gates by ${error} (RMS)`,
        ground: (status: string) => `Lowest level: ${status}`,
        hidden: (value: string) => `Lowest level: ${value}, which is not shown`,
        outside: 'Outside the grid',
        layers: {
            plane: 'on the plane',
            section: 'on the section',
            surface: 'on the surface',
            maximum: 'maximum of the column',
        },
        greatestOf,
    },
    tools: {
        name: 'Tools',
        distanceName: 'Distance',
        areaName: 'Area',
        flyName: 'Fly',
        raw: 'Raw volume',
        noRaw: 'The server does not have the raw files of this grid.',
        hint: (measure: 'distance' | 'area') =>
            measure === 'distance' ? 'Click both ends. Escape ends this.' : 'Click the corners. Escape ends this.',
        distance: (distance: string, azimuth: number, height: string) =>
            `${distance}, azimuth ${azimuth}°, height ${height}`,
        area: (area: string, around: string) => `${area}, ${around} around`,
        flyHint: 'W A S D move, E and Q lift and sink, drag or arrows turn, Shift is faster. Escape lands.',
        profile: 'Values of the column over height',
    },
    start: {
        title: 'Where do you want to look?',
        help: 'Click a radar. Drag to move; with Shift, or after Box, drag a box over several.',
        toMap: 'Map',
        mapLabel: 'Map of all stations. Arrow keys go from one to the next, Enter opens it, B begins a box.',
        box: 'Box',
        all: 'Whole map',
        back: 'Back to the view',
        search: 'Station or city',
        mosaic: 'several sites',
        region: 'Region',
        ofVolumes,
        sitesAt,
        leftOut,
        halved: (halvings: number) => `each cell is the ${greatestOf(halvings)}`,
        ownVelocities: 'each velocity is toward or away from its own radar',
        merging: (sites: string[]) => `Merging ${sites.join(', ')}`,
        nothing: 'no data',
        unpictured: (count: number) =>
            `The echo of ${count === 1 ? '1 more radar' : `${count} more radars`} is not drawn here.`,
        lacksEcho: 'Some of the echo is not loaded yet.',
        noneFound: 'No station or city matches.',
        noGridsOf: (domain: string) => `There are no grids of ${domain}.`,
        age,
        from: (km: number, city: string) => `${km} km from ${city}`,
        boxed: (sites: string[]) =>
            sites.length === 0
                ? 'No site with grids is in the box.'
                : `${sites.length === 1 ? '1 site' : `${sites.length} sites`} in the box: ${sites.join(', ')}. Others that reach it are merged too.`,
        card: (domain: string, name: string, ageS: number | null, moments: string[], strongest: number | null) =>
            [
                name ? `${domain}, ${name}` : domain,
                ageS === null ? 'no data' : age(ageS),
                moments.length === 0 ? 'no grids' : moments.join(' '),
                strongest === null ? '' : `strongest echo ${Math.round(strongest)} dBZ`,
            ]
                .filter(Boolean)
                .join(' · '),
    },
} as const;

// Returns the name of a state that has no value.
export function stateText(state: Exclude<CellState, CellState.value>): string {
    switch (state) {
        case CellState.notSeen:
            return texts.notSeen;
        case CellState.noEcho:
            return texts.noEcho;
        case CellState.rangeFolded:
            return texts.rangeFolded;
        case CellState.ambiguous:
            return texts.ambiguous;
    }
}

// Texts of the editor of colors, which the page loads when it is first opened.
export const editorTexts = {
    title: 'Colors and opacity',
    preset: 'Table',
    undo: 'Undo',
    redo: 'Redo',
    import: 'Import',
    toToml: 'Save .toml',
    toPal: 'Save .pal',
    close: 'Close the editor',
    colors: 'Points of color',
    opacities: 'Points of opacity',
    point: (kind: 'color' | 'opacity', number: number) => `${kind === 'color' ? 'Color' : 'Opacity'} ${number}`,
    colorIs: (value: string, [red, green, blue]: readonly number[]) =>
        `${value}: red ${red}, green ${green}, blue ${blue}`,
    opacityIs: (value: string, perKm: number) => `${value}: ${perKm} per km`,
    perKm: '/km',
    value: 'Value',
    color: 'Color',
    opacity: 'Opacity per km',
    add: 'Add',
    remove: 'Remove',
    edited: (name: string) => `${name} (edited)`,
    noRoom: 'There is no room for another point here.',
    lastPoints: 'The last points cannot be removed.',
    saved: (name: string) => `Saved as ${name}; stormcellar frame --colors ${name} draws the same.`,
    savedInPart: (name: string) => `Saved as ${name}, but a .pal cannot make echo denser than usual. A .toml can.`,
    taken: (name: string, points: number) => `${name} is shown, with ${points} points of color.`,
    otherMoment: (name: string, moment: string) => `${name} is for ${moment}: choose ${moment} to see it.`,
    otherEnding: (name: string) => `${name}: the file of a color table must end in .pal or .toml.`,
    otherUnit: (name: string, unit: string, wanted: string) =>
        `${name}: its values are in ${unit}, not in ${wanted || 'numbers without a unit'}.`,
    tooLarge: (name: string) => `${name}: a file of a color table has at most 1 MiB.`,
};
