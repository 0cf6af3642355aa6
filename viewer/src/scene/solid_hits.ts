// Finds where a ray from the eye meets a plane, a section, a sweep or the column maximum, and what each shows there.
// Results are null if the ray does not meet the layer.
//
// Heights are above sea level, and depths are as in ViewGeometry.

import { Ray } from '../camera/ray';
import { FlatField } from '../fields/flat_field';
import { Section } from '../fields/section';
import { Mixer } from '../fields/status_rule';
import { azimuthSteps, beamAt, beamTo, noRadial } from '../fields/sweep_cone';
import { CellState } from '../wire/packed_grid';
import { PackedSweep, stateOfGate } from '../wire/packed_sweep';
import { depthsWithin } from './first_visible';
import { Extent } from './grid_box';
import { Crop } from './layers';
import { GridPlane, Plane, geodesic } from '../earth/projection';

export interface SolidHit {
    depth: number;
    at: Plane;
    heightM: number;
    state: CellState;
    value: number;
}
export interface GateHit extends SolidHit {
    station: string;
    azimuthDeg: number;
    rangeM: number;
    elevationDeg: number;
    timeMs: number;
}

const radians = Math.PI / 180;

// Reads a field at a place in its texels, as the shader of layers does. If `mixes` is false, takes the nearest texel.
export function fieldAt(field: FlatField, x: number, y: number, mixes: boolean): { state: CellState; value: number } {
    const { width, height, states, values } = field;
    const index = (column: number, row: number) =>
        Math.min(height - 1, Math.max(0, row)) * width + Math.min(width - 1, Math.max(0, column));
    const nearest = index(Math.floor(x), Math.floor(y));
    if (!mixes) return { state: states[nearest]!, value: values[nearest]! };
    const [left, low] = [Math.floor(x - 0.5), Math.floor(y - 0.5)];
    const [across, up] = [x - 0.5 - left, y - 0.5 - low];
    const mixer = new Mixer('mean');
    for (const [column, row] of [
        [0, 0],
        [1, 0],
        [0, 1],
        [1, 1],
    ] as const) {
        const at = index(left + column, low + row);
        mixer.add(states[at]!, values[at]!, (column ? across : 1 - across) * (row ? up : 1 - up));
    }
    mixer.result();
    return { state: mixer.state, value: mixer.value };
}

// Returns true if the eye can see a depth. In perspective it sees nothing behind itself.
const isAhead = ({ geometry }: Ray, depth: number): boolean =>
    Number.isFinite(depth) && (depth > 0 || !geometry.isPerspective);

// Finds where a ray meets a field that covers an extent of the plane at a height.
export function levelHit(
    ray: Ray,
    { field, extent }: { field: FlatField; extent: Extent },
    heightM: number,
    mixes: boolean,
): SolidHit | null {
    const depth = ray.depthAt(heightM);
    if (!isAhead(ray, depth)) return null;
    const at = ray.at(depth);
    const [across, up] = [
        (at[0] - extent.westM) / (extent.eastM - extent.westM),
        (at[1] - extent.southM) / (extent.northM - extent.southM),
    ];
    if (!(across >= 0 && across < 1 && up >= 0 && up < 1)) return null;
    const { halfXM, halfYM } = ray.geometry.box;
    if (Math.abs(at[0]) > halfXM || Math.abs(at[1]) > halfYM) return null;
    return { depth, at, heightM, ...fieldAt(field, across * field.width, up * field.height, mixes) };
}

// Finds where a ray first meets a section, which is a row of upright strips.
export function sectionHit(ray: Ray, section: Section, mixes: boolean): SolidHit | null {
    const { start, way } = ray;
    const { field, ends } = section;
    let best: SolidHit | null = null;
    for (let column = 0; column < field.width; ++column) {
        const [a, b] = [ends[column]!, ends[column + 1]!];
        const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        // Solve start + depth * way = a + share * (b - a) for depth and share, seen from above.
        const turn = way[0] * dy - way[1] * dx;
        const depth = ((a[0] - start[0]) * dy - (a[1] - start[1]) * dx) / turn;
        const share = ((a[0] - start[0]) * way[1] - (a[1] - start[1]) * way[0]) / turn;
        if (!(share >= 0 && share < 1) || !isAhead(ray, depth) || (best && best.depth < depth)) continue;
        const heightM = ray.heightM(depth);
        const row = ((heightM - section.bottomM) / (section.topM - section.bottomM)) * field.height;
        if (!(row >= 0 && row < field.height) || section.inGrid[column] === 0) continue;
        const at: Plane = [a[0] + share * dx, a[1] + share * dy];
        best = { depth, at, heightM, ...fieldAt(field, column + share, row, mixes) };
    }
    return best;
}

const steps = 400; // number of steps of the ray, among which the step that crosses the beam is found
const halvings = 30; // number of times that this step is halved
const beyondM = 1000; // margin of the box below the lowest gate and above the highest

// Returns a box that holds a sweep; null if the projection cannot show the site.
function boxOfSweep(gates: PackedSweep, plane: GridPlane): Crop | null {
    const site = plane.toPlane(gates);
    const lastM = gates.firstGateM + Math.max(0, ...gates.gateCounts) * gates.gateSpacingM;
    if (!site) return null;
    const heights = [0, lastM].map((rangeM) => beamAt(gates, gates.elevationDeg, rangeM).heightM);
    const [low, high] = [Math.min(...heights) - beyondM, Math.max(...heights) + beyondM];
    return {
        westM: site[0] - lastM,
        eastM: site[0] + lastM,
        southM: site[1] - lastM,
        northM: site[1] + lastM,
        bottomM: low,
        topM: high,
    };
}

interface PlacedSweep {
    station: string;
    gates: PackedSweep;
    radials: Uint16Array;
}

// Finds the gate where a ray crosses the cone of a sweep. A ray from the side crosses the cone twice. Returns the first
// shown gate, because gates that are not shown are clear; if no gate is shown, returns the first gate.
export function sweepHit(
    ray: Ray,
    { station, gates, radials }: PlacedSweep,
    plane: GridPlane,
    isShown: (hit: SolidHit) => boolean,
): GateHit | null {
    const box = boxOfSweep(gates, plane);
    const depths = box && depthsWithin(ray, box);
    if (!depths) return null;
    const seenAt = (depth: number) => {
        const [at, heightM] = [ray.at(depth), ray.heightM(depth)];
        const { distanceM, azimuth } = geodesic(gates, plane.toPlace(at));
        const azimuthDeg = (azimuth / radians + 360) % 360;
        return { depth, at, heightM, azimuthDeg, ...beamTo(gates, distanceM, heightM) };
    };
    const isAbove = (depth: number) => seenAt(depth).elevationDeg > gates.elevationDeg;
    let from = isAbove(depths[0]);
    let first: GateHit | null = null;
    for (let i = 1; i <= steps; ++i) {
        let [low, high] = [i - 1, i].map((n) => depths[0] + (n / steps) * (depths[1] - depths[0])) as [number, number];
        if (isAbove(high) === from) continue;
        for (let k = 0; k < halvings; ++k) {
            const middle = (low + high) / 2;
            if (isAbove(middle) === from) low = middle;
            else high = middle;
        }
        const hit = gateAt(gates, radials, { station, ...seenAt(high) });
        if (hit && isShown(hit)) return hit;
        first ??= hit;
        from = !from;
    }
    return first;
}

// Finds the gate of a place on the cone of a sweep; null beyond the gates.
export function gateAt(
    gates: PackedSweep,
    radials: Uint16Array,
    place: Omit<GateHit, 'state' | 'value' | 'timeMs'>,
): GateHit | null {
    const gate = Math.floor(0.5 + (place.rangeM - gates.firstGateM) / gates.gateSpacingM);
    const radial = radials[Math.min(azimuthSteps - 1, Math.floor((place.azimuthDeg * azimuthSteps) / 360))]!;
    if (gate < 0) return null;
    const hit = { ...place, elevationDeg: gates.elevationDeg };
    if (radial === noRadial) return { ...hit, state: CellState.notSeen, value: 0, timeMs: gates.startMs };
    if (gate >= gates.gateCounts[radial]!) return null;
    const code = gates.codes[radial * gates.gateStride + gate]!;
    return {
        ...hit,
        state: stateOfGate(gates, code),
        value: (code - gates.offset) / gates.scale,
        timeMs: gates.timesMs[radial]!,
    };
}
