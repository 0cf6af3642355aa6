// What a ray from the eye meets first, from the exact codes of the grid.

import { ViewGeometry } from '../camera/geometry';
import { PackedGrid, codeAt, firstValueCode, valueOf } from '../wire/packed_grid';
import { Cells } from './grid_box';
import { Crop } from './layers';
import { Plane, cellSizeM } from './projection';

export interface Seen {
    at: Plane; // meters from the middle of the grid
    heightM: number; // above sea level
    value: number;
}

const stepsACell = 2;
const mostSteps = 6000;

// The level whose cells hold a height.
function levelAt(grid: PackedGrid, heightM: number): number {
    let level = 0;
    while (level + 1 < grid.nz && heightM >= (grid.levelsM[level]! + grid.levelsM[level + 1]!) / 2) ++level;
    return level;
}

// Where a ray is within a box: the first and the last depth; null where it passes by.
function depthsWithin(geometry: ViewGeometry, box: Crop, x: number, y: number): [number, number] | null {
    const start = geometry.point(x, y, 0);
    const way = geometry.along(x, y);
    const least = [box.westM, box.southM, box.bottomM * geometry.exaggeration];
    const most = [box.eastM, box.northM, box.topM * geometry.exaggeration];
    let [near, far] = [geometry.isPerspective ? 0 : -Infinity, Infinity];
    for (let axis = 0; axis < 3; ++axis) {
        const [a, b] = [(least[axis]! - start[axis]!) / way[axis]!, (most[axis]! - start[axis]!) / way[axis]!];
        if (Math.abs(way[axis]!) < 1e-12) {
            if (start[axis]! < least[axis]! || start[axis]! > most[axis]!) return null;
            continue;
        }
        near = Math.max(near, Math.min(a, b));
        far = Math.min(far, Math.max(a, b));
    }
    return near < far ? [near, far] : null;
}

// Where the ray through a pixel enters and leaves a box, on the plane; null where it passes by.
export function wayWithin(geometry: ViewGeometry, box: Crop, x: number, y: number): [Plane, Plane] | null {
    const depths = depthsWithin(geometry, box, x, y);
    const start = geometry.point(x, y, 0);
    const way = geometry.along(x, y);
    const at = (depth: number): Plane => [start[0] + depth * way[0], start[1] + depth * way[1]];
    return depths && [at(depths[0]), at(depths[1])];
}

// The first cell along the ray through a pixel whose value is visible, within a box; null if there is none.
// `cells` is a grid, and where its middle is on the plane of the view.
export function firstVisible({ grid, middle }: Cells, geometry: ViewGeometry, box: Crop, x: number, y: number, isVisible: (value: number) => boolean): Seen | null {
    const depths = depthsWithin(geometry, box, x, y);
    if (!depths) return null;
    const [width, height] = cellSizeM(grid);
    const start = geometry.point(x, y, 0);
    const way = geometry.along(x, y);
    // Half a cell on the ground, or of the least height of a level, whichever the ray crosses first.
    let thinnestM = Infinity;
    for (let z = 1; z < grid.nz; ++z) thinnestM = Math.min(thinnestM, grid.levelsM[z]! - grid.levelsM[z - 1]!);
    const perMeter = Math.max(Math.abs(way[0]) / width, Math.abs(way[1]) / height, Math.abs(way[2]) / (thinnestM * geometry.exaggeration), 1e-9);
    const step = Math.max(1 / (stepsACell * perMeter), (depths[1] - depths[0]) / mostSteps);
    for (let depth = depths[0] + step / 2; depth < depths[1]; depth += step) {
        const at: Plane = [start[0] + depth * way[0], start[1] + depth * way[1]];
        const heightM = (start[2] + depth * way[2]) / geometry.exaggeration;
        const [column, row] = [Math.floor((at[0] - middle[0]) / width + 0.5 * grid.nx), Math.floor((at[1] - middle[1]) / height + 0.5 * grid.ny)];
        if (column < 0 || row < 0 || column >= grid.nx || row >= grid.ny) continue;
        const level = levelAt(grid, heightM);
        const code = codeAt(grid, column, row, level);
        if (code < firstValueCode) continue;
        const value = valueOf(grid, code);
        if (isVisible(value)) return { at, heightM: grid.levelsM[level]!, value };
    }
    return null;
}
