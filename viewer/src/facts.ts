// Facts that the page shares with the C++ source, written by tests/repository/viewer_facts_test.cpp: change
// them there.

// Moments with their stored units ('1' for a number without one), and how cells are mixed between their centers.
export const moments = {
    REF: { unit: 'dBZ', mixing: 'mean' },
    VEL: { unit: 'm/s', mixing: 'heaviest' },
    SW: { unit: 'm/s', mixing: 'mean' },
    ZDR: { unit: 'dB', mixing: 'mean' },
    PHI: { unit: 'degree', mixing: 'circle' },
    RHO: { unit: '1', mixing: 'mean' },
    CFP: { unit: 'dB', mixing: 'mean' },
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

// Projections by their names in JSON, and their numbers in packed grids.
export const projections = {
    azimuthal_equidistant: 0,
    latitude_longitude: 1,
    lambert_conformal: 2,
} as const;

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
    border: [120, 130, 146, 255],
    text: [234, 238, 243],
    quietText: [166, 177, 192],
    halo: [8, 10, 14, 225],
} as const;
