// Makes a small table of reflectivity, and a small usual opacity, for tests.

import { ColorTable, Rgba } from '../wire/color_tables';
import { usualOpacity } from '../tables/usual_opacity';

const black: Rgba = [0, 0, 0, 255];
const red: Rgba = [200, 40, 20, 255];
const white: Rgba = [255, 255, 255, 255];

const perDecibel = Array.from({ length: 76 }, (_, i) => ({ value: 5 + i, per_km: 0.001 * 1.1 ** i }));

export const smooth: ColorTable = {
    name: 'smooth',
    moment: 'REF',
    unit: 'dBZ',
    stops: [
        { from: 5, color: black, until: [100, 20, 10, 255] },
        { from: 20, color: [100, 20, 10, 255], until: red },
        { from: 35, color: red, until: white },
        { from: 65, color: white, until: white },
    ],
    end: 80,
    bar_begin: 5,
    range_folded: [119, 0, 125, 255],
    extinction: perDecibel,
};
export const velocity: ColorTable = {
    ...smooth,
    name: 'velocity',
    moment: 'VEL',
    unit: 'm/s',
    extinction: [
        { value: -50, per_km: 0.5 },
        { value: 0, per_km: 0.01 },
        { value: 50, per_km: 0.5 },
    ],
};
export const usual = usualOpacity([smooth, velocity], { REF: 'smooth', VEL: 'velocity' });
