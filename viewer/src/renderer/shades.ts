// The quiet colors behind the echo, as render/image/shades.h has them for the dark theme.

export const shades = {
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
    lake: [138, 158, 182, 200],
    border: [120, 130, 146, 255],
    axis: 'rgba(120, 130, 146, 0.35)',
    histogram: 'rgba(166, 177, 192, 0.30)',
    text: 'rgb(234, 238, 243)',
    quietText: 'rgb(166, 177, 192)',
    halo: 'rgba(8, 10, 14, 0.88)',
} as const;
