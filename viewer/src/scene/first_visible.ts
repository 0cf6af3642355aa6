// Finds the first visible cell and the most visible cell along a ray from the eye, by the exact codes of a grid.

import { Ray } from '../camera/ray';
import { CellState, PackedGrid, codeAt, valueOf } from '../wire/packed_grid';
import { Cells } from './grid_box';
import { Crop } from './layers';
import { Plane, cellSizeM } from '../earth/projection';

export interface Seen {
    at: Plane; // meters from the middle of the grid
    heightM: number; // above sea level
    value: number;
}

const stepsACell = 2;
const mostSteps = 6000;

// Returns the level whose cells hold a height.
function levelAt(grid: PackedGrid, heightM: number): number {
    let level = 0;
    while (level + 1 < grid.nz && heightM >= (grid.levelsM[level]! + grid.levelsM[level + 1]!) / 2) ++level;
    return level;
}

// Returns the first and the last depth of a ray within a box; null if the ray misses the box.
export function depthsWithin({ geometry, start, way }: Ray, box: Crop): [number, number] | null {
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

// Returns the places on the plane where a ray enters and leaves a box; null if the ray misses the box.
export function wayWithin(ray: Ray, box: Crop): [Plane, Plane] | null {
    const depths = depthsWithin(ray, box);
    return depths && [ray.at(depths[0]), ray.at(depths[1])];
}

interface Step {
    code: number;
    cell: number; // index of the cell
    at: Plane; // middle of the step
    heightM: number; // height of the cell's level
    lengthM: number; // length of the step, in drawn space
}

// Visits cells along a ray, within a box and before the depth `untilDepth`. Stops if `visit` returns true.
function walk({ grid, middle }: Cells, ray: Ray, box: Crop, untilDepth: number, visit: (step: Step) => boolean): void {
    const depths = depthsWithin(ray, box);
    if (!depths) return;
    const [width, height] = cellSizeM(grid);
    const { way, geometry } = ray;
    // A step crosses half a cell along the ground or half of the thinnest level, whichever the ray crosses sooner. It
    // is at least 1 / mostSteps of the way long.
    let thinnestM = Infinity;
    for (let z = 1; z < grid.nz; ++z) thinnestM = Math.min(thinnestM, grid.levelsM[z]! - grid.levelsM[z - 1]!);
    const perMeter = Math.max(
        Math.abs(way[0]) / width,
        Math.abs(way[1]) / height,
        Math.abs(way[2]) / (thinnestM * geometry.exaggeration),
        1e-9,
    );
    const step = Math.max(1 / (stepsACell * perMeter), (depths[1] - depths[0]) / mostSteps);
    const lengthM = step * Math.hypot(...way);
    for (let depth = depths[0] + step / 2; depth < Math.min(depths[1], untilDepth); depth += step) {
        const at = ray.at(depth);
        const [column, row] = [
            Math.floor((at[0] - middle[0]) / width + 0.5 * grid.nx),
            Math.floor((at[1] - middle[1]) / height + 0.5 * grid.ny),
        ];
        if (column < 0 || row < 0 || column >= grid.nx || row >= grid.ny) continue;
        const level = levelAt(grid, ray.heightM(depth));
        const code = codeAt(grid, column, row, level);
        const cell = (level * grid.ny + row) * grid.nx + column;
        if (visit({ code, cell, at, heightM: grid.levelsM[level]!, lengthM })) return;
    }
}

// Returns the first cell with a visible value along a ray within a box; null if there is none.
export function firstVisible(cells: Cells, ray: Ray, box: Crop, isVisible: (value: number) => boolean): Seen | null {
    let seen: Seen | null = null;
    walk(cells, ray, box, Infinity, ({ code, at, heightM }) => {
        if (code < cells.grid.firstCode) return false;
        const value = valueOf(cells.grid, code);
        if (isVisible(value)) seen = { at, heightM, value };
        return seen !== null;
    });
    return seen;
}

// Describes which parts of the volume and of the background a pixel shows.
export interface Contribution {
    cell: Seen | null; // cell that contributes most; null: no echo is visible
    share: number; // share of the pixel that this cell contributes
    through: number; // share of the pixel that the background contributes
    foldedM: number; // length of the ray in range folded air, in drawn space
}

const opaque = 0.002; // the ray ends when the background's share of the pixel is less than this

// Finds the cell along a ray that contributes most to its pixel. `perM` returns the extinction of a value per drawn
// meter; 0 for a clear value.
export function mostVisible(
    cells: Cells,
    ray: Ray,
    box: Crop,
    untilDepth: number,
    perM: (value: number) => number,
): Contribution {
    const found: Contribution = { cell: null, share: 0, through: 1, foldedM: 0 };
    const ofCode = new Map<number, number>();
    let [cell, share] = [-1, 0];
    walk(cells, ray, box, untilDepth, (step) => {
        const { code, lengthM } = step;
        if (code === CellState.rangeFolded) found.foldedM += lengthM;
        if (code < cells.grid.firstCode) return false;
        const value = valueOf(cells.grid, code);
        if (!ofCode.has(code)) ofCode.set(code, perM(value));
        const depth = ofCode.get(code)! * lengthM;
        if (!(depth > 0)) return false;
        const seen = -found.through * Math.expm1(-depth);
        share = step.cell === cell ? share + seen : seen;
        cell = step.cell;
        if (share > found.share) Object.assign(found, { share, cell: { at: step.at, heightM: step.heightM, value } });
        found.through -= seen;
        return found.through < opaque;
    });
    return found;
}
