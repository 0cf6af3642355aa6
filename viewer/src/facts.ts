// Facts that the page shares with the C++ source, written by tests/repository/viewer_facts_test.cpp: change
// them there.

// Moments in the order of their numbers in packed grids and sweeps, with their stored units ('1' for a number
// without one), and how cells are mixed between their centers.
export const moments = {
    REF: { unit: 'dBZ' },
    VEL: { unit: 'm/s', mixing: 'heaviest', isSigned: true, isDoppler: true },
    SW: { unit: 'm/s', isDoppler: true },
    ZDR: { unit: 'dB' },
    PHI: { unit: 'degree', mixing: 'circle' },
    RHO: { unit: '1' },
    CFP: { unit: 'dB' },
    VELD: { unit: 'm/s', isSigned: true, isDoppler: true, isDerived: true, measured: 'VEL', tables: 'VEL' },
    SRV: { unit: 'm/s', isSigned: true, isDoppler: true, isDerived: true, measured: 'VEL', tables: 'VEL' },
    AZSH: { unit: '0.001/s', isSigned: true, isDoppler: true, isDerived: true, measured: 'VEL' },
    DIVG: { unit: '0.001/s', isSigned: true, isDoppler: true, isDerived: true, measured: 'VEL', tables: 'AZSH' },
    POW: { unit: '1', isDerived: true, measured: 'REF' },
    KDP: { unit: 'degree/km', isDerived: true, measured: 'PHI' },
    RATE: { unit: 'mm/h', isDerived: true, measured: 'REF' },
    HCA: { unit: '1', isDerived: true, measured: 'REF' },
} as const;
export const momentTitles = {
    REF: 'Reflectivity',
    VEL: 'Radial velocity',
    SW: 'Spectrum width',
    ZDR: 'Differential reflectivity',
    PHI: 'Differential phase',
    RHO: 'Correlation coefficient',
    CFP: 'Clutter filter power removed',
    VELD: 'Dealiased velocity',
    SRV: 'Storm-relative velocity',
    AZSH: 'Azimuthal shear',
    DIVG: 'Radial divergence',
    POW: 'Probability of weather',
    KDP: 'Specific differential phase',
    RATE: 'Rain rate',
    HCA: 'Hydrometeor class',
} as const;

// Units by quantity, the usual one first.
export const units = {
    speed: [
        { name: 'm/s', symbol: 'm/s', si: 1 },
        { name: 'knots', symbol: 'kt', si: 0.5144444444444445 },
        { name: 'mph', symbol: 'mph', si: 0.44704 },
        { name: 'km/h', symbol: 'km/h', si: 0.2777777777777778 },
    ],
    distance: [
        { name: 'km', symbol: 'km', si: 1000 },
        { name: 'miles', symbol: 'mi', si: 1609.344 },
        { name: 'nautical-miles', symbol: 'nmi', si: 1852 },
    ],
    height: [
        { name: 'km', symbol: 'km', si: 1000 },
        { name: 'kft', symbol: 'kft', si: 304.8 },
        { name: 'feet', symbol: 'ft', si: 0.3048 },
    ],
} as const;

// Projections by their names in JSON, with their numbers in packed grids. Cells are regular in degrees or meters.
export const projections = {
    azimuthal_equidistant: { number: 0, isInDegrees: false },
    latitude_longitude: { number: 1, isInDegrees: true },
    lambert_conformal: { number: 2, isInDegrees: false },
} as const;

// The grid that `stormcellar frame` makes of a raw file.
export const usualGrid = { nx: 460, ny: 460, spacingM: 1000, levels: 32, betweenLevelsM: 500 } as const;

// Ranges of numbers that pictures take. A field of view may be 0, too.
export const ranges = {
    sidePx: { least: 16, most: 8192 },
    tiltDeg: { least: 0, most: 90 },
    zoom: { least: 0.01, most: 1000 },
    fieldOfViewDeg: { least: 1, most: 150 },
    sectionKm: { least: 1, most: 5000 },
    planeM: { least: -1000, most: 60000 },
    exaggeration: { least: 0.1, most: 100 },
    opacity: { least: 0.001, most: 1000 },
} as const;

// Limits of files of color tables, the color of range folded air where a file has none, and the table of clear air.
export const colorFiles = {
    mostBytes: 1048576,
    mostStops: 4096,
    greatestValue: 1000000,
    rangeFolded: [119, 0, 125, 255],
    clearAir: 'smooth-clear-air',
} as const;

// Products of .pal files with moment and unit of their values; their units, as how many make one of ours.
export const palProducts: Record<string, { moment?: string; unit: string }> = {
    BR: { moment: 'REF', unit: 'dBZ' },
    CR: { moment: 'REF', unit: 'dBZ' },
    BV: { moment: 'VEL', unit: 'm/s' },
    CC: { moment: 'RHO', unit: '' },
    ET: { unit: 'km' },
    EET: { unit: 'km' },
    VIL: { unit: 'kg/m2' },
    DVL: { unit: 'kg/m2' },
};
export const palUnits: Record<string, [number, string]> = {
    KT: [1.943844, 'm/s'],
    KTS: [1.943844, 'm/s'],
    KNOTS: [1.943844, 'm/s'],
    MPH: [2.236936, 'm/s'],
    KMH: [3.6, 'm/s'],
    'KM/H': [3.6, 'm/s'],
    'M/S': [1, 'm/s'],
    MPS: [1, 'm/s'],
    KFT: [3.28084, 'km'],
    FT: [3280.84, 'km'],
    KM: [1, 'km'],
    M: [1000, 'km'],
    DBZ: [1, 'dBZ'],
    DB: [1, 'dB'],
    'KG/M2': [1, 'kg/m2'],
    '%': [100, ''],
};

// Colors behind the echo, of the dark theme: red, green, blue and, for lines and the halo, alpha to 255.
export const dark = {
    page: [11, 14, 19],
    seen: [40, 44, 50],
    seenAloft: [29, 32, 37],
    notSeen: [23, 25, 29],
    beyond: [25, 28, 33],
    water: { seen: [22, 31, 46], seenAloft: [17, 24, 36], notSeen: [15, 20, 28], beyond: [14, 19, 29] },
    hatch: [78, 82, 92],
    haze: [104, 110, 122],
    ring: [160, 174, 194, 110],
    county: [118, 124, 132, 130],
    state: [164, 170, 180, 235],
    country: [200, 203, 208, 245],
    coast: [138, 158, 182, 240],
    interstate: [164, 132, 104, 190],
    highway: [150, 126, 104, 150],
    border: [120, 130, 146, 255],
    text: [234, 238, 243],
    quietText: [166, 177, 192],
    halo: [8, 10, 14, 225],
} as const;

// Kinds of lines of the map in the order in which they are drawn. Lines are shown only where the usual distance
// between them is at least so many pixels.
export const mapKinds = {
    county: { usualM: 45000, leastPixels: 30 },
    highway: { usualM: 33000, leastPixels: 60 },
    interstate: { usualM: 100000, leastPixels: 40 },
    state: { usualM: 0, leastPixels: 0 },
    lake: { usualM: 0, leastPixels: 0 },
    country: { usualM: 0, leastPixels: 0 },
    coast: { usualM: 0, leastPixels: 0 },
} as const;

// Colors of events in the map of hazards of the National Weather Service.
export const eventColors = [
    { event: 'Tornado Warning', color: [255, 0, 0] },
    { event: 'Severe Thunderstorm Warning', color: [255, 165, 0] },
    { event: 'Flash Flood Warning', color: [139, 0, 0] },
    { event: 'Special Marine Warning', color: [255, 165, 0] },
    { event: 'Snow Squall Warning', color: [199, 21, 133] },
    { event: 'Flood Warning', color: [0, 255, 0] },
    { event: 'Flood Advisory', color: [0, 255, 127] },
    { event: 'Special Weather Statement', color: [255, 228, 181] },
    { event: 'Tornado Watch', color: [255, 255, 0] },
    { event: 'Severe Thunderstorm Watch', color: [219, 112, 147] },
] as const;
