// Cuts a vertical section along the geodesic between two places, as render/products/section.h does. Values are bilinear
// between columns and linear between levels; the status rule (status_rule.ts) decides the state.

import { heightRange } from '../camera/geometry';
import { Place, Plane, cellSizeM, destination, geodesic, planeOf } from '../earth/projection';
import { CellState, PackedGrid, codeAt, stateOf, valueOf } from '../wire/packed_grid';
import { FlatField, LevelPair, emptyField, levelsAbout } from './flat_field';
import { Mixer, mixingOf } from './status_rule';

export interface Section {
    lengthM: number;
    bottomM: number; // sea level, or the bottom of the lowest cells if that is lower
    topM: number;
    field: FlatField; // columns from the first place to the second, rows from the bottom up
    inGrid: Uint8Array; // 1 for columns of the field that are in the grid, else 0
    ends: Plane[]; // where columns begin, and where the last column ends; NaN where the plane has no place
}

// Returns the two cells on both sides of a place along an axis, and the weight of the second; null beyond the cells.
function neighbors(at: number, count: number): [number, number, number] | null {
    if (!(at >= -0.5 && at <= count - 0.5)) return null;
    const inside = Math.min(count - 1, Math.max(0, at));
    const first = Math.min(Math.floor(inside), Math.max(0, count - 2));
    return [first, Math.min(first + 1, count - 1), inside - first];
}

interface Corners {
    codes: Uint16Array[]; // of the four columns about a place, by level
    weights: number[];
}

function cornersAt(grid: PackedGrid, across: [number, number, number], along: [number, number, number]): Corners {
    const codes: Uint16Array[] = [];
    const weights: number[] = [];
    for (let i = 0; i < 4; ++i) {
        const [x, wx] = i % 2 === 1 ? [across[1], across[2]] : [across[0], 1 - across[2]];
        const [y, wy] = i >= 2 ? [along[1], along[2]] : [along[0], 1 - along[2]];
        const column = new Uint16Array(grid.nz);
        for (let z = 0; z < grid.nz; ++z) column[z] = codeAt(grid, x, y, z);
        codes.push(column);
        weights.push(wx * wy);
    }
    return { codes, weights };
}

function fillColumn(
    grid: PackedGrid,
    field: FlatField,
    column: number,
    rows: (LevelPair | null)[],
    corners: Corners,
    mixer: Mixer,
): void {
    for (let row = 0; row < field.height; ++row) {
        const levels = rows[row];
        if (!levels) continue;
        mixer.clear();
        for (let i = 0; i < 4; ++i) {
            const [lower, upper] = [corners.codes[i]![levels.lower]!, corners.codes[i]![levels.upper]!];
            mixer.add(stateOf(grid, lower), valueOf(grid, lower), corners.weights[i]! * (1 - levels.upperShare));
            mixer.add(stateOf(grid, upper), valueOf(grid, upper), corners.weights[i]! * levels.upperShare);
        }
        mixer.result();
        field.states[row * field.width + column] = mixer.state;
        field.values[row * field.width + column] = mixer.value;
    }
}

export function cutSection(
    grid: PackedGrid,
    moment: string,
    from: Place,
    to: Place,
    width: number,
    height: number,
): Section {
    const heights = heightRange(grid.levelsM);
    const way = geodesic(from, to);
    const plane = planeOf(grid);
    const section: Section = {
        lengthM: way.distanceM,
        bottomM: Math.min(0, heights.bottomM),
        topM: heights.topM,
        field: emptyField(width, height),
        inGrid: new Uint8Array(width),
        ends: [],
    };
    const at = (share: number): Plane =>
        plane.toPlane(destination(from, way.azimuth, share * way.distanceM)) ?? [NaN, NaN];
    for (let i = 0; i <= width; ++i) section.ends.push(at(i / width));
    const rows = Array.from({ length: height }, (_, row) =>
        levelsAbout(grid.levelsM, section.bottomM + ((row + 0.5) / height) * (section.topM - section.bottomM)),
    );
    const [cellX, cellY] = cellSizeM(grid);
    const mixer = new Mixer(mixingOf(moment));
    for (let column = 0; column < width; ++column) {
        const [x, y] = at((column + 0.5) / width);
        const across = neighbors(x / cellX + 0.5 * (grid.nx - 1), grid.nx);
        const along = neighbors(y / cellY + 0.5 * (grid.ny - 1), grid.ny);
        if (!across || !along) continue;
        section.inGrid[column] = 1;
        fillColumn(grid, section.field, column, rows, cornersAt(grid, across, along), mixer);
    }
    return section;
}

// Returns the greatest value of a section and its place; null without values.
export function greatestOf({
    field,
    lengthM,
    bottomM,
    topM,
}: Section): { value: number; distanceM: number; heightM: number } | null {
    let best = -1;
    for (let i = 0; i < field.states.length; ++i) {
        if (field.states[i] === CellState.value && (best < 0 || field.values[i]! > field.values[best]!)) best = i;
    }
    if (best < 0) return null;
    const [column, row] = [best % field.width, Math.floor(best / field.width)];
    return {
        value: field.values[best]!,
        distanceM: ((column + 0.5) / field.width) * lengthM,
        heightM: bottomM + ((row + 0.5) / field.height) * (topM - bottomM),
    };
}
