// Prepares a color table for steps through a volume. A transfer function has the color and the optical depth of a step
// for each pair of values at its ends, as render/volume/transfer_function.h does (pre-integrated, second order).

import { firstValueCode } from '../wire/packed_grid';
import { colorOf, extinctionPerM } from './color_table';
import { ColorTable } from '../wire/color_tables';

export const binCount = 256;
const binSlack = 1 / 64;

export interface Transfer {
    // bin = binOffset + binSlope * code; bin 0 is clear
    binOffset: number;
    binSlope: number;
    leastVisibleCode: number; // Infinity if nothing is visible
    // Four numbers for each pair of bins: red, green, blue (0 to 1) and optical depth of a step of the reference
    // length. The row is the bin of the nearer end, and the column the bin of the farther end.
    entries: Float32Array;
}

export interface Shown {
    opacity: number; // scales the table's extinction
    least: number; // smaller values are clear
}

export interface Bins {
    lowest: number;
    width: number;
}

// Chooses the bins of values for a table. Unless two stops are closer than the narrowest bin, their smallest distance
// is a whole number of bins, so that the stops of an evenly spaced table begin bins. With a threshold `least`, bins are
// chosen as for a table that begins at the threshold, as the table of a saved file does (draft.ts).
export function chooseBins(table: ColorTable, least = -Infinity): Bins {
    const { extinction } = table;
    const all = table.stops.map((stop) => stop.from);
    const stops = least > all[0]! ? [least, ...all.filter((from) => from > least)] : all;
    const lowest = Math.max(stops[0]!, extinction[0]!.value);
    const highest = Math.max(stops[stops.length - 1]!, extinction[extinction.length - 1]!.value);
    const range = Math.max(highest - lowest, 1e-6);
    let gap = range;
    for (let i = 1; i < stops.length; ++i) gap = Math.min(gap, stops[i]! - stops[i - 1]!);
    const finest = range / (binCount - 2);
    const binsAGap = Math.floor((gap / finest) * (1 + 1e-9));
    return { lowest, width: binsAGap >= 1 ? gap / binsAGap : finest };
}

interface Looks {
    depth: Float64Array;
    color: [Float64Array, Float64Array, Float64Array];
}

function looksOfBins(table: ColorTable, bins: Bins, shown: Shown, stepM: number): Looks {
    const looks: Looks = {
        depth: new Float64Array(binCount),
        color: [new Float64Array(binCount), new Float64Array(binCount), new Float64Array(binCount)],
    };
    for (let i = 1; i < binCount; ++i) {
        const value = bins.lowest + (i - 0.5) * bins.width;
        if (value < shown.least) continue;
        looks.depth[i] = extinctionPerM(table, value, shown.opacity) * stepM;
        const color = colorOf(table, value);
        if (color) for (let c = 0; c < 3; ++c) looks.color[c]![i] = Math.round(color[c]!) / 255;
    }
    return looks;
}

// Integrates a step from the bin `from` to the bin from + sign * distance, and stores its entry.
function putStep(
    looks: Looks,
    from: number,
    distance: number,
    sign: number,
    whole: Float64Array,
    half: Float64Array,
    entries: Float32Array,
): void {
    let red = 0;
    let green = 0;
    let blue = 0;
    let depth = 0;
    let through = 1;
    for (let m = 0; m <= distance; ++m) {
        const bin = from + sign * m;
        const isEnd = m === 0 || m === distance;
        const seen = through * (isEnd ? half[bin]! : whole[bin]!);
        red += seen * looks.color[0][bin]!;
        green += seen * looks.color[1][bin]!;
        blue += seen * looks.color[2][bin]!;
        through -= seen;
        depth += (isEnd ? 0.5 : 1) * looks.depth[bin]!;
    }
    const seen = 1 - through;
    if (!(seen > 0)) return;
    const at = 4 * (from * binCount + from + sign * distance);
    entries[at] = red / seen;
    entries[at + 1] = green / seen;
    entries[at + 2] = blue / seen;
    entries[at + 3] = depth / distance;
}

export function makeTransfer(
    table: ColorTable,
    quantization: { firstValue: number; step: number },
    shown: Shown,
    stepM: number,
): Transfer {
    const bins = chooseBins(table, shown.least);
    const codeZero = quantization.firstValue - quantization.step * firstValueCode;
    const looks = looksOfBins(table, bins, shown, stepM);
    const entries = new Float32Array(4 * binCount * binCount);
    for (let i = 0; i < binCount; ++i) {
        if (looks.depth[i]! <= 0) continue;
        const at = 4 * (i * binCount + i);
        for (let c = 0; c < 3; ++c) entries[at + c] = looks.color[c]![i]!;
        entries[at + 3] = looks.depth[i]!;
    }
    const whole = new Float64Array(binCount);
    const half = new Float64Array(binCount);
    for (let distance = 1; distance < binCount; ++distance) {
        for (let i = 0; i < binCount; ++i) {
            whole[i] = -Math.expm1(-looks.depth[i]! / distance);
            half[i] = -Math.expm1((-0.5 * looks.depth[i]!) / distance);
        }
        for (let i = 0; i < binCount - distance; ++i) {
            putStep(looks, i, distance, 1, whole, half, entries);
            putStep(looks, i + distance, distance, -1, whole, half, entries);
        }
    }
    const binSlope = quantization.step / bins.width;
    const binOffset = (codeZero - bins.lowest) / bins.width + 1 + binSlack;
    const firstVisible = looks.depth.findIndex((depth) => depth > 0);
    return {
        binOffset,
        binSlope,
        leastVisibleCode:
            firstVisible < 0 ? Infinity : Math.max(firstValueCode, Math.ceil((firstVisible - binOffset) / binSlope)),
        entries,
    };
}
