// Edits drafts. An edit does not change the given draft. It returns a new draft, or the given draft if the edit is not
// possible.

import { Rgba } from '../wire/color_tables';
import { Draft, OpacityPoint, colorAt, mostPoints, perKmAt, roundedPerKm, roundedValue } from './draft';

// Returns the least distance between two points of a draft.
export function leastGap(draft: Draft): number {
    return Math.max(0.0005, Math.abs(draft.end - draft.colors[0]!.value) / 500);
}

// Returns the value nearest to `wanted` that keeps the points [first, last] between their neighbors.
function between(points: { value: number }[], first: number, last: number, wanted: number, gap: number): number {
    const low = first > 0 ? points[first - 1]!.value + gap : -Infinity;
    const high = last + 1 < points.length ? points[last + 1]!.value - gap : Infinity;
    return roundedValue(Math.max(low, Math.min(high, wanted)));
}

// Moves a point of color to another value. Both points of an edge move together.
export function withColorMoved(draft: Draft, at: number, value: number): Draft {
    const { colors } = draft;
    const here = colors[at]!.value;
    const first = colors[at - 1]?.value === here ? at - 1 : at;
    const last = colors[at + 1]?.value === here ? at + 1 : at;
    const moved = between(colors, first, last, value, leastGap(draft));
    return {
        ...draft,
        colors: colors.map((point, i) => (i >= first && i <= last ? { ...point, value: moved } : point)),
    };
}

export function withColor(
    draft: Draft,
    at: number,
    [red, green, blue]: readonly [number, number, number, ...number[]],
): Draft {
    const color = (before: Rgba): Rgba => [red, green, blue, before[3]];
    return {
        ...draft,
        colors: draft.colors.map((point, i) => (i === at ? { ...point, color: color(point.color) } : point)),
    };
}

const isFree = (points: { value: number }[], value: number, gap: number): boolean =>
    points.every((point) => Math.abs(point.value - value) >= 0.999 * gap);
const byValue = (a: { value: number }, b: { value: number }): number => a.value - b.value;

// Adds a point of color. Returns the draft and the index of the new point; -1 if there is no room.
export function withColorAdded(draft: Draft, wanted: number): [Draft, number] {
    const value = roundedValue(wanted);
    if (draft.colors.length >= mostPoints || !isFree(draft.colors, value, leastGap(draft))) return [draft, -1];
    const colors = [...draft.colors, { value, color: colorAt(draft, value) }].sort(byValue);
    return [{ ...draft, colors }, colors.findIndex((point) => point.value === value)];
}

export function withColorRemoved(draft: Draft, at: number): Draft {
    if (draft.colors.length <= (draft.isStepped ? 1 : 2)) return draft;
    return { ...draft, colors: draft.colors.filter((_, i) => i !== at) };
}

export function withOpacityMoved(
    draft: Draft,
    opacity: OpacityPoint[],
    at: number,
    value: number,
    perKm: number,
): Draft {
    const moved = { value: between(opacity, at, at, value, leastGap(draft)), perKm: roundedPerKm(Math.max(0, perKm)) };
    return { ...draft, opacity: opacity.map((point, i) => (i === at ? moved : point)) };
}

export function withOpacityAdded(
    draft: Draft,
    opacity: OpacityPoint[],
    wanted: number,
    perKm?: number,
): [Draft, number] {
    const value = roundedValue(wanted);
    if (opacity.length >= mostPoints || !isFree(opacity, value, leastGap(draft))) return [draft, -1];
    const added = [...opacity, { value, perKm: roundedPerKm(perKm ?? perKmAt(opacity, value)) }].sort(byValue);
    return [{ ...draft, opacity: added }, added.findIndex((point) => point.value === value)];
}

export function withOpacityRemoved(draft: Draft, opacity: OpacityPoint[], at: number): Draft {
    if (opacity.length <= 1) return draft;
    return { ...draft, opacity: opacity.filter((_, i) => i !== at) };
}
