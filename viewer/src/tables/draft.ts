// Converts color tables to drafts, and drafts to tables. A draft is a table that is being edited; it has so few points
// of color and opacity that a user can move each of them.
//
// Numbers of a draft are rounded as in files and addresses, so that saving changes nothing. The page draws the table
// that the draft's file has, so `stormcellar frame` draws the same picture with this file.

import { ColorTable, ExtinctionPoint, Rgba } from '../wire/color_tables';
import { colorDistance, cornersToKeep, mixed } from './simplify';
import { FilePoint, TableFile, greatestValue, tableOfFile, usualExtinctionOf } from './table_file';
import { UsualOpacity } from './usual_opacity';

export interface ColorPoint {
    value: number;
    color: Rgba;
}
export interface OpacityPoint {
    value: number;
    perKm: number;
}
export interface Draft {
    name: string;
    moment: string;
    unit: string;
    isStepped: boolean; // each color holds up to the next point; otherwise colors blend from point to point
    colors: ColorPoint[]; // values rise; two points at one value make an edge
    opacity: OpacityPoint[] | null; // constant beyond the outermost points; null: the usual opacity, faded by alpha
    end: number; // end of the color bar
    barBegin: number; // beginning of the color bar
    rangeFolded: Rgba;
}

export const mostPoints = 160;
const nearEnough = 0.012; // allowed error of a color, in OKLab
const alphaWeight = 0.25;
const nearEnoughShare = 0.06; // allowed relative error of an opacity
const clearestPerKm = 0.003; // errors of opacities below this are relative to it
const leastStep = 0.0005; // least difference between two values

export const roundedValue = (value: number): number =>
    Number(Math.min(greatestValue, Math.max(-greatestValue, value)).toFixed(4));
export const roundedPerKm = (perKm: number): number =>
    perKm < 1e-4 ? 0 : Number(Math.min(greatestValue, perKm).toPrecision(3));
const roundedColor = (color: Rgba): Rgba => color.map(Math.round) as Rgba;

// ---- From tables

function simplifiedColors(points: ColorPoint[], most: number): ColorPoint[] {
    const kept = cornersToKeep(points.length, most, (first, last, i) => {
        const [a, b, p] = [points[first]!, points[last]!, points[i]!];
        if (b.value <= a.value) return 0;
        const line = mixed(a.color, b.color, (p.value - a.value) / (b.value - a.value));
        return Math.max(colorDistance(line, p.color), (alphaWeight * Math.abs(line[3] - p.color[3])) / 255);
    });
    return kept.map((i) => points[i]!);
}

// Returns the points of a table that blends. Simplifies the colors between two edges separately, and keeps the edges.
function blendedPoints(table: ColorTable, most: number): ColorPoint[] {
    const points: ColorPoint[] = [];
    let run: ColorPoint[] = [];
    const endRun = () => {
        points.push(...simplifiedColors(run, most));
        run = [];
    };
    table.stops.forEach(({ from, color, until }, i) => {
        run.push({ value: roundedValue(from), color });
        const next = table.stops[i + 1];
        if (!next || until.every((c, k) => c === next.color[k])) return;
        run.push({ value: roundedValue(next.from), color: until });
        endRun();
    });
    endRun();
    return points;
}

function colorsOf(table: ColorTable): { isStepped: boolean; colors: ColorPoint[] } {
    const isStepped = table.stops.every(({ color, until }) => color.every((c, k) => c === until[k]));
    const plain = table.stops.map(({ from, color }) => ({ value: roundedValue(from), color }));
    if (isStepped && plain.length <= mostPoints) return { isStepped, colors: plain };
    // Let colors blend if there are more classes than a draft can have points.
    let colors = isStepped ? simplifiedColors(plain, nearEnough) : blendedPoints(table, nearEnough);
    for (let most = 2 * nearEnough; colors.length > mostPoints && most < 4; most *= 2) {
        colors = isStepped || most > 0.5 ? simplifiedColors(plain, most) : blendedPoints(table, most);
    }
    return { isStepped: false, colors: colors.slice(0, mostPoints) };
}

function simplifiedOpacity(points: ExtinctionPoint[], lowest: number): OpacityPoint[] {
    let most = nearEnoughShare;
    const known = [...points];
    // Nothing is drawn below the first point of a table.
    const first = known[0]!;
    if (first.value > lowest && first.per_km > 0)
        known.unshift({ value: lowest, per_km: 0 }, { value: first.value - leastStep, per_km: 0 });
    const error = (i: number, j: number, k: number) => {
        const [a, b, p] = [known[i]!, known[j]!, known[k]!];
        const line = a.per_km + ((b.per_km - a.per_km) * (p.value - a.value)) / (b.value - a.value);
        return Math.abs(line - p.per_km) / Math.max(p.per_km, clearestPerKm);
    };
    let kept = cornersToKeep(known.length, most, error);
    while (kept.length > mostPoints) kept = cornersToKeep(known.length, (most *= 2), error);
    return kept.map((i) => ({ value: roundedValue(known[i]!.value), perKm: roundedPerKm(known[i]!.per_km) }));
}

const isSame = (a: ExtinctionPoint[], b: ExtinctionPoint[]): boolean =>
    a.length === b.length &&
    a.every((point, i) => point.value === b[i]!.value && Math.abs(point.per_km - b[i]!.per_km) <= 1e-9);

// Returns a draft with few points that looks like the table.
export function draftOf(table: ColorTable, moment: string, usual: UsualOpacity): Draft {
    const lowest = table.stops[0]!.from;
    const hasUsual = table.moment === moment && isSame(table.extinction, usualExtinctionOf(table, usual));
    return {
        name: table.name.replace(/[^\w.-]/g, '-').slice(0, 60),
        moment,
        unit: table.unit,
        ...colorsOf(table),
        opacity: hasUsual ? null : simplifiedOpacity(table.extinction, lowest),
        end: roundedValue(table.end),
        barBegin: roundedValue(table.bar_begin),
        rangeFolded: table.range_folded,
    };
}

// ---- To tables

// Returns the index of the last point at or below a value, or 0 if all points are above it. Also returns how far the
// value is on the way to the next point, from 0 to 1.
function placeAmong(points: { value: number }[], value: number): [number, number] {
    let i = points.length - 1;
    while (i > 0 && points[i]!.value > value) --i;
    const [here, next] = [points[i]!, points[i + 1]];
    if (!next || value <= here.value) return [i, 0];
    return [i, (value - here.value) / (next.value - here.value)];
}

export function colorAt(draft: Draft, value: number): Rgba {
    const [i, share] = placeAmong(draft.colors, value);
    const here = draft.colors[i]!;
    return draft.isStepped || share === 0
        ? here.color
        : roundedColor(mixed(here.color, draft.colors[i + 1]!.color, share));
}

export function perKmAt(points: OpacityPoint[], value: number): number {
    const [i, share] = placeAmong(points, value);
    const here = points[i]!;
    return share === 0 ? here.perKm : here.perKm + share * (points[i + 1]!.perKm - here.perKm);
}

// Returns the content of the draft's file, without values below `least`.
export function fileOf(draft: Draft, least: number | null = null): TableFile {
    const { colors, opacity } = draft;
    const lowest = colors[0]!.value;
    const from = least === null ? lowest : Math.max(lowest, roundedValue(least));
    const perKm = (value: number) => (opacity ? Number(perKmAt(opacity, value).toPrecision(6)) : null);
    const points = new Map<number, FilePoint>();
    const edges = new Map<number, Rgba>();
    const put = (value: number, color: Rgba) => points.set(value, { value, color, perKm: perKm(value) });
    put(from, colorAt(draft, from));
    colors.forEach(({ value, color }, i) => {
        if (value <= from) return;
        // The color at the lower side of an edge becomes `until` of the point below.
        if (colors[i + 1]?.value !== value) put(value, color);
        else edges.set(value, color);
    });
    for (const { value } of opacity ?? []) if (value > from && !points.has(value)) put(value, colorAt(draft, value));
    const sorted = [...points.values()].sort((a, b) => a.value - b.value);
    sorted.forEach((point, i) => {
        const until = edges.get(sorted[i + 1]?.value ?? NaN);
        if (until) point.until = until;
    });
    const last = sorted[sorted.length - 1]!;
    if (sorted.length === 1 && !draft.isStepped) sorted.push({ ...last, value: roundedValue(last.value + 1) });
    const end = Math.max(draft.end, roundedValue(sorted[sorted.length - 1]!.value + 0.01));
    return {
        name: draft.name,
        moment: draft.moment,
        unit: draft.unit,
        isStepped: draft.isStepped,
        end,
        rangeFolded: draft.rangeFolded,
        points: sorted,
    };
}

export function tableOf(draft: Draft, usual: UsualOpacity, least: number | null = null): ColorTable {
    const table = tableOfFile(fileOf(draft, least), usual);
    return { ...table, bar_begin: Math.max(table.bar_begin, draft.barBegin) };
}

// Returns the table for a .pal file, whose alpha is the opacity relative to the usual opacity. `isWhole` is false if a
// color of the table is clearly more opaque than usual, which a .pal file cannot express.
export function tableForPal(
    draft: Draft,
    usual: UsualOpacity,
    least: number | null,
): { table: ColorTable; isWhole: boolean } {
    const table = tableOf(draft, usual, least);
    if (!draft.opacity) return { table, isWhole: true };
    const points = usual
        .of(draft.moment, table.stops[0]!.from)
        .map((point) => ({ value: point.value, perKm: point.per_km }));
    let isWhole = true;
    const withAlpha = (color: Rgba, value: number): Rgba => {
        const usualPerKm = perKmAt(points, value);
        const wanted = perKmAt(
            table.extinction.map((point) => ({ value: point.value, perKm: point.per_km })),
            value,
        );
        const share = usualPerKm > 0 ? wanted / usualPerKm : 1;
        if (share > 1 + nearEnoughShare) isWhole = false;
        return [color[0], color[1], color[2], Math.round(255 * Math.min(1, share))];
    };
    const stops = table.stops.map(({ from, color, until }, i) => ({
        from,
        color: withAlpha(color, from),
        until: withAlpha(until, table.stops[i + 1]?.from ?? from),
    }));
    return { table: { ...table, stops }, isWhole };
}
