// Places an upright axis of heights and its marks in the picture.

import { ViewGeometry } from '../camera/geometry';
import { Unit } from '../tables/units';
import { Plane } from '../earth/projection';

export interface HeightAxis {
    foot: [number, number]; // pixels of the picture
    head: [number, number];
    marks: { at: [number, number]; number: number }[]; // heights in the chosen unit
}

const leastPixels = 45;
const leastBetween = 22;
const parts = 32; // number of parts of the axis over the whole box; parts outside of the picture are not drawn
const steps = [1, 2, 5, 10, 20, 50];

// Returns the axis over a place of the ground, up to the top of the box or the edge of the picture; null if it is too
// short, as in a view from above.
function axisOver(
    geometry: ViewGeometry,
    [x, y]: Plane,
    { si }: Unit,
    pixelRatio: number,
    isFree: (x: number, y: number) => boolean,
): HeightAxis | null {
    const at = (heightM: number) => geometry.project([x, y, heightM * geometry.exaggeration]);
    const foot = at(geometry.groundM);
    if (!foot || !isFree(...foot)) return null;
    let [head, topM] = [foot, geometry.groundM];
    for (let i = 1; i <= parts; ++i) {
        const heightM = geometry.groundM + (i / parts) * (geometry.box.topM - geometry.groundM);
        const pixel = at(heightM);
        if (!pixel || !isFree(...pixel)) break;
        [head, topM] = [pixel, heightM];
    }
    const long = Math.hypot(head[0] - foot[0], head[1] - foot[1]) / pixelRatio;
    if (long < leastPixels) return null;
    const most = topM / si;
    const power = si < 1 ? 1000 : 1; // marks in feet are at thousands
    const step = steps.map((one) => one * power).find((one) => (long * one) / most >= leastBetween);
    if (step === undefined) return null;
    const marks: HeightAxis['marks'] = [];
    for (let number = 0; number <= most; number += step) {
        const mark = at(number * si);
        if (mark) marks.push({ at: mark, number });
    }
    return marks.length > 1 ? { foot, head, marks } : null;
}

// Places the axis at the leftmost free corner of the grid, or in the left part of the picture if no corner is free.
// Returns null if there is no place for the axis. `isFree` returns true for pixels that are in the picture and not
// covered.
export function heightAxis(
    geometry: ViewGeometry,
    unit: Unit,
    pixelRatio: number,
    isFree: (x: number, y: number) => boolean,
): HeightAxis | null {
    const { halfXM, halfYM } = geometry.box;
    const corners = [-1, 1].flatMap((x) => [-1, 1].map((y): Plane => [x * halfXM, y * halfYM]));
    const found = corners
        .map((corner) => axisOver(geometry, corner, unit, pixelRatio, isFree))
        .filter((one): one is HeightAxis => one !== null);
    if (found.length > 0) return found.reduce((best, one) => (one.foot[0] < best.foot[0] ? one : best));
    for (const share of [0.85, 0.75, 0.65, 0.55, 0.45]) {
        const place = geometry.ground(60 * pixelRatio, share * geometry.height);
        if (!place || Math.abs(place[0]) > halfXM || Math.abs(place[1]) > halfYM) continue;
        const axis = axisOver(geometry, place, unit, pixelRatio, isFree);
        if (axis) return axis;
    }
    return null;
}
