// Has the texts of programs that the page loads later: panels, layers, the map of all
// stations, and the editor of colors.

import { age, greatestOf } from './texts';

// Texts of settings, tools and readings.
export const panelTexts = {
    editColors: 'Edit colors and opacity',
    threshold: 'Hide values below',
    nothingHidden: 'nothing is hidden',
    opacity: 'Opacity',
    exaggeration: 'Heights times',
    colors: 'Colors',
    perspective: 'Perspective',
    views: 'View',
    top: 'Top',
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
    greatestAt: (value: string, height: string) => `Maximum ${value} at ${height} above sea level`,
    place: (latitudeDeg: number, longitudeDeg: number) =>
        `${Math.abs(latitudeDeg).toFixed(3)} ${latitudeDeg < 0 ? 'S' : 'N'}, ${Math.abs(longitudeDeg).toFixed(3)} ${longitudeDeg < 0 ? 'W' : 'E'}`,
    column: 'The column there:',
    seenBetween: (from: string, to: string) => `seen ${from} – ${to} above sea level`,
    units: { all: 'Units', speed: 'Speeds', distance: 'Distances', height: 'Heights' },
    quality: 'Exactness',
    asTimeAllows: 'as time allows',
    rung: (name: string, dE: number) => `${name}: dE ${dE}`,
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
} as const;

// Texts of the panel of layers.
export const layerTexts = {
    volume: 'Volume',
    plane: 'Plane at a height',
    section: 'Vertical section',
    surface: 'Surface of a value',
    maximum: 'Column maximum on the ground',
    sweep: 'Sweep in its place',
    glyphs: 'Beam glyphs on a sweep of velocity',
    rotation: 'Rotation',
    cells: 'Storm cells',
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
    planeAt: (height: string) => `${height} above sea level`,
    dealiasSweep: 'Dealiased',
    weatherSweep: 'Weather only',
} as const;

// Texts of the section's plot and of beam glyphs.
export const plotTexts = {
    glyphAlong: (speed: string) => `${speed} along the beam`,
    glyphAcross: 'wind across the beam: not observed',
    plot: 'Vertical section: distance from A to B, and height. Arrow keys read it.',
    told: (what: string, distance: string, height: string) => `${what}, ${distance} from A, ${height} above sea level`,
    greatest: (told: string) => `Greatest ${told}`,
    nothing: 'The section has no echo.',
    nothingButFolded: 'The section has range-folded air, but no echo.',
    nothingButAmbiguous: 'The section has only ambiguous echo, which has no value.',
} as const;

// Texts of the map of all stations.
export const mapTexts = {
    title: 'Where do you want to look?',
    help: 'Click a radar. Drag to move; with Shift, or after Box, drag a box over several.',
    mapLabel: 'Map of all stations. Arrow keys go from one to the next, Enter opens it, B begins a box.',
    box: 'Box',
    all: 'Whole map',
    back: 'Back to the view',
    search: 'Station or city',
    mosaic: 'several sites',
    merging: (sites: string[]) => `Merging ${sites.join(', ')}`,
    nothing: 'no data',
    unpictured: (count: number) =>
        `The echo of ${count === 1 ? '1 more radar' : `${count} more radars`} is not drawn here.`,
    lacksEcho: 'Some of the echo is not loaded yet.',
    noneFound: 'No station or city matches.',
    noGridsOf: (domain: string) => `There are no grids of ${domain}.`,
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
} as const;

// Texts of the editor of colors.
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
