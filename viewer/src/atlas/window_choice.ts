// Chooses which window of a grid in parts to ask for (`window` of docs/web/packed-grid.md). A window is a rectangle of
// columns that covers all that a view, a line or a ray meets. It is halved until it is within limits.

import { Plane, cellSizeM } from '../earth/projection';
import { PackedGrid } from '../wire/packed_grid';
import { Pyramid, mostHalvings } from './pyramid';
import { Placed, finestPixels, seenColumns } from './view_choice';

// Columns and rows of the grid itself, both ends included.
export interface Bounds {
    x: [number, number];
    y: [number, number];
}
// Columns of bricks of the grid after `level` halvings, both ends included.
export interface BrickWindow extends Bounds {
    level: number;
}
export interface WindowLimits {
    columns: number; // most columns of cells in a window
    bytes: number; // most bytes of codes and states in a window
}

const mostBricks = 16384; // the server refuses larger windows
const statesBlockBytes = 1024;

const clipped = (from: number, to: number, count: number): [number, number] | null =>
    to < 0 || from >= count ? null : [Math.max(0, from), Math.min(count - 1, to)];

// Returns the smallest range of the grid's columns and rows about all points, cut off at the border of the grid.
// Returns null without points, or if all points are beyond one side of the grid.
export function boundsAbout(points: readonly Plane[], grid: PackedGrid): Bounds | null {
    const size = cellSizeM(grid);
    const along = (axis: 0 | 1, count: number) => {
        const all = points.map((point) => Math.floor(point[axis] / size[axis] + 0.5 * count)).filter(Number.isFinite);
        return all.length > 0 ? clipped(Math.min(...all), Math.max(...all), count) : null;
    };
    const [x, y] = [along(0, grid.nx), along(1, grid.ny)];
    return x && y && { x, y };
}

type Table = Pick<PackedGrid, 'nx' | 'ny' | 'brickEdge' | 'codeBytes'>;

// Returns the window of a level that holds the bounds and `more` cells of the level on each side.
function windowOf(bounds: Bounds, level: number, more: number, pyramid: Pyramid, { brickEdge }: Table): BrickWindow {
    const cell = 2 ** level;
    const columns = pyramid.levels[level]!.columns;
    const along = (axis: 0 | 1, [from, to]: [number, number]): [number, number] => {
        const brick = (at: number) => Math.min(columns[axis] - 1, Math.max(0, Math.floor(at / (brickEdge * cell))));
        return [brick(from - more * cell), brick(to + more * cell)];
    };
    return { level, x: along(0, bounds.x), y: along(1, bounds.y) };
}

function fits(
    { level, x, y }: BrickWindow,
    pyramid: Pyramid,
    { brickEdge, codeBytes }: Table,
    limits: WindowLimits,
): boolean {
    const { layers, levels } = pyramid;
    const { columns, greatest } = levels[level]!;
    const count = (x[1] - x[0] + 1) * (y[1] - y[0] + 1);
    if (count * layers > mostBricks || count * brickEdge ** 2 > limits.columns) return false;
    let bytes = 0;
    for (let bx = x[0]; bx <= x[1]; ++bx) {
        for (let i = (bx * columns[1] + y[0]) * layers; i < (bx * columns[1] + y[1] + 1) * layers; ++i) {
            bytes += greatest[i]! > 0 ? brickEdge ** 3 * codeBytes : statesBlockBytes;
        }
    }
    return bytes <= limits.bytes;
}

// Returns the window about the bounds at the finest level that is within the limits. Tries no level finer than
// `finest`. If no level is within the limits, returns the window of the coarsest level.
export function windowAbout(
    bounds: Bounds,
    finest: number,
    more: number,
    pyramid: Pyramid,
    table: Table,
    limits: WindowLimits,
): BrickWindow {
    for (let level = finest; ; ++level) {
        const window = windowOf(bounds, level, more, pyramid, table);
        if (level >= mostHalvings || fits(window, pyramid, table, limits)) return window;
    }
}

// Returns the window of the part of the grid that a view shows, with or without echo; null if the view shows none.
export function windowSeen(placed: Placed, pyramid: Pyramid, table: Table, limits: WindowLimits): BrickWindow | null {
    const seen = seenColumns(placed, pyramid, finestPixels);
    if (seen.length === 0) return null;
    const bounds: Bounds = { x: [Infinity, -Infinity], y: [Infinity, -Infinity] };
    let finest = mostHalvings;
    for (const { level, x, y } of seen) {
        finest = Math.min(finest, level);
        const take = ([from, to]: [number, number], brick: number, count: number): [number, number] => {
            const first = brick * table.brickEdge * 2 ** level;
            return [Math.min(from, first), Math.min(count - 1, Math.max(to, first + table.brickEdge * 2 ** level - 1))];
        };
        bounds.x = take(bounds.x, x, table.nx);
        bounds.y = take(bounds.y, y, table.ny);
    }
    return windowAbout(bounds, finest, 0, pyramid, table, limits);
}

// Returns true if `window` covers `other` and has the same level, so that the page need not ask for `other`.
export function holds(window: BrickWindow, other: BrickWindow): boolean {
    const covers = (one: [number, number], two: [number, number]) => one[0] <= two[0] && one[1] >= two[1];
    return window.level === other.level && covers(window.x, other.x) && covers(window.y, other.y);
}

// Returns the parameters by which the server is asked for a window.
export function windowQuery({ level, x, y }: BrickWindow): Record<string, string> {
    const halved: Record<string, string> = level > 0 ? { half: String(level), by: 'maximum' } : {};
    return { ...halved, window: `${x.join('-')},${y.join('-')}` };
}
