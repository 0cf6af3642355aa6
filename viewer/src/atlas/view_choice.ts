// Chooses the columns of bricks that a view needs, and their levels (numbers of halvings; pyramid.ts). The columns
// cover the visible part of the grid, are no finer than pixels show, and fit into the room.

import { ViewGeometry, Vec3 } from '../camera/geometry';
import { Pyramid } from './pyramid';
import { columnKey } from './slot_pool';

export interface WantedColumn {
    level: number;
    x: number;
    y: number;
    key: string;
    away: number; // pixels from the column's middle to the picture's; 0 if the column reaches behind the camera
}

// A view, and the sizes of a grid's bricks and cells.
export interface Placed {
    geometry: ViewGeometry;
    edge: number; // width of a brick, in cells
    cellSizeM: [number, number];
}

// Width of a cell in the picture, in pixels, beyond which the view wants cells half as wide.
export const finestPixels = 1.5;

interface Extent {
    isSeen: boolean;
    pixelsACell: number; // width of a cell of level 0
    away: number;
}

function extentOf(placed: Placed, level: number, x: number, y: number): Extent {
    const { geometry, edge, cellSizeM } = placed;
    const { box, exaggeration, width, height } = geometry;
    const low = [x, y].map((n, axis) => n * edge * 2 ** level * cellSizeM[axis]! - [box.halfXM, box.halfYM][axis]!) as [
        number,
        number,
    ];
    const high = [0, 1].map((axis) =>
        Math.min([box.halfXM, box.halfYM][axis]!, low[axis]! + edge * 2 ** level * cellSizeM[axis]!),
    ) as [number, number];
    let [left, right, top, bottom, nearest] = [Infinity, -Infinity, Infinity, -Infinity, Infinity];
    let isBehind = false;
    for (let i = 0; i < 8; ++i) {
        const corner: Vec3 = [
            i & 1 ? high[0] : low[0],
            i & 2 ? high[1] : low[1],
            (i & 4 ? box.topM : box.bottomM) * exaggeration,
        ];
        const depth = geometry.depthOf(corner);
        nearest = Math.min(nearest, depth);
        const pixel = geometry.project(corner);
        if (!pixel) {
            isBehind = true;
            continue;
        }
        [left, right] = [Math.min(left, pixel[0]), Math.max(right, pixel[0])];
        [top, bottom] = [Math.min(top, pixel[1]), Math.max(bottom, pixel[1])];
    }
    // A box that reaches behind the camera may be anywhere in the picture. A box that is all behind the camera is not
    // seen.
    const isSeen = left <= right && (isBehind || (right >= 0 && left <= width && bottom >= 0 && top <= height));
    const metersPerPixel = geometry.isPerspective
        ? Math.max(nearest, geometry.nearM) / geometry.focalPixels
        : geometry.metersPerPixel;
    const away = isSeen && !isBehind ? Math.hypot((left + right - width) / 2, (top + bottom - height) / 2) : 0;
    return { isSeen, pixelsACell: Math.max(...cellSizeM) / metersPerPixel, away };
}

function collect(
    placed: Placed,
    pyramid: Pyramid,
    [finest, coarsest]: [number, number],
    mostPixels: number,
    isWanted: (level: number, x: number, y: number) => boolean,
): WantedColumn[] {
    const found: WantedColumn[] = [];
    const visit = (level: number, x: number, y: number): void => {
        const { columns } = pyramid.levels[level]!;
        if (x >= columns[0] || y >= columns[1] || !isWanted(level, x, y)) return;
        const extent = extentOf(placed, level, x, y);
        if (!extent.isSeen) return;
        if (level <= finest || extent.pixelsACell * 2 ** level <= mostPixels) {
            found.push({ level, x, y, key: columnKey(level, x, y), away: extent.away });
            return;
        }
        for (let i = 0; i < 4; ++i) visit(level - 1, 2 * x + (i & 1), 2 * y + (i >> 1));
    };
    const [nx, ny] = pyramid.levels[coarsest]!.columns;
    for (let x = 0; x < nx; ++x) for (let y = 0; y < ny; ++y) visit(coarsest, x, y);
    return found;
}

// Returns the columns that the view needs, sorted from the middle of the picture outward. `levels` are the finest and
// the coarsest level to choose from. At most `room` bricks are finer than the coarsest level: cells get coarser until
// this holds.
export function wantedColumns(
    placed: Placed,
    pyramid: Pyramid,
    levels: [number, number],
    room: number,
): WantedColumn[] {
    const coarsest = levels[1];
    const hasShown = (level: number, x: number, y: number): boolean => {
        const { columns, shown } = pyramid.levels[level]!;
        return shown[x * columns[1] + y]! > 0;
    };
    for (let mostPixels = finestPixels; ; mostPixels *= Math.SQRT2) {
        const found = collect(placed, pyramid, levels, mostPixels, hasShown);
        const bricks = found.reduce((sum, { level, x, y }) => {
            const { columns, shown } = pyramid.levels[level]!;
            return sum + (level === coarsest ? 0 : shown[x * columns[1] + y]!);
        }, 0);
        if (bricks <= room) return found.sort((one, other) => one.away - other.away);
    }
}

// Returns all columns that a view shows, with or without echo. Each is of the coarsest level whose cells are at most
// `mostPixels` wide, or of level 0 if even its cells are wider.
export function seenColumns(placed: Placed, pyramid: Pyramid, mostPixels: number): WantedColumn[] {
    return collect(placed, pyramid, [0, pyramid.levels.length - 1], mostPixels, () => true);
}
