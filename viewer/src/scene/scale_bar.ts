// Finds a bar of a round length for the scale of the picture at its center, along the ground.

import { ViewGeometry } from '../camera/geometry';
import { legOf } from '../earth/measure';
import { GridPlane, Plane } from '../earth/projection';
import { Unit } from '../tables/units';

const halfM = 500; // half the distance that is measured at the center
const farthest = 2; // half widths of the grid, as far as the map reaches

export interface ScaleBar {
    number: number; // length of the bar, in the unit
    pixels: number; // of the picture
}

// Returns the longest bar of 1, 2 or 5 times a power of ten units that has at most `mostPixels`. Returns null if the
// center of the picture shows the sky, or ground far from the grid.
export function scaleBar(geometry: ViewGeometry, plane: GridPlane, unit: Unit, mostPixels: number): ScaleBar | null {
    const { width, height, right, box } = geometry;
    const center = geometry.ground(width / 2, height / 2);
    if (!center || Math.hypot(...center) > farthest * Math.max(box.halfXM, box.halfYM)) return null;
    const at = (m: number): Plane => [center[0] + m * right[0], center[1] + m * right[1]];
    const pixelOf = (m: number) => geometry.project([...at(m), geometry.groundM * geometry.exaggeration]);
    const [from, to] = [pixelOf(-halfM), pixelOf(halfM)];
    if (!from || !to) return null;
    const { distanceM } = legOf(plane.toPlace(at(-halfM)), plane.toPlace(at(halfM)));
    const pixelsPerUnit = ((to[0] - from[0]) / distanceM) * unit.si;
    const power = 10 ** Math.floor(Math.log10(mostPixels / pixelsPerUnit));
    const number = ([5, 2].find((one) => one * power * pixelsPerUnit <= mostPixels) ?? 1) * power;
    return { number, pixels: number * pixelsPerUnit };
}
