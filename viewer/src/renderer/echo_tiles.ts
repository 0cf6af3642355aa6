// Finds the tiles (squares of the picture) in which rays may meet visible echo, and between which depths. The volume is
// drawn in these tiles only, because most of a usual picture shows clear air.

import { Atlas, blockEdge, blocksABrick, blocksAlong, slotOf } from '../atlas/atlas';
import { Vec3, ViewGeometry } from '../camera/geometry';
import { cellSizeM } from '../earth/projection';
import { PackedGrid } from '../wire/packed_grid';
import { Program } from './program';

// The camera of a picture, or of a smaller picture of the same view. Width and height need not be whole numbers.
export type RayView = Pick<
    ViewGeometry,
    'width' | 'height' | 'eye' | 'right' | 'up' | 'forward' | 'focalPixels' | 'metersPerPixel' | 'isPerspective'
>;

// Coordinates in drawn space at which the blocks of cells along each axis begin, and at which the last block ends.
export interface BlockEnds {
    x: number[];
    y: number[];
    z: number[];
}

// Along each axis, a sample belongs to the block (of 4 x 4 x 4 cells; atlas/atlas.ts) of the cell before it. So blocks
// begin at the middles of cells. The outermost blocks reach to the faces of the box.
export function blockEnds(grid: PackedGrid, { box, exaggeration }: ViewGeometry): BlockEnds {
    const [width, height] = cellSizeM(grid);
    const along = (bricks: number, cells: number, placeOf: (cell: number) => number, low: number, high: number) =>
        Array.from({ length: blocksAlong * bricks + 1 }, (_, i) =>
            i === 0 ? low : blockEdge * i < cells ? placeOf(blockEdge * i) : high,
        );
    const [x, y, z] = grid.bricks;
    return {
        x: along(x, grid.nx, (cell) => (cell - 0.5 * (grid.nx - 1)) * width, -box.halfXM, box.halfXM),
        y: along(y, grid.ny, (cell) => (cell - 0.5 * (grid.ny - 1)) * height, -box.halfYM, box.halfYM),
        z: along(
            z,
            grid.nz,
            (level) => grid.levelsM[level]! * exaggeration,
            box.bottomM * exaggeration,
            box.topM * exaggeration,
        ),
    };
}

export interface Tiles {
    side: number; // side of a tile, in pixels
    columns: number;
    rows: number; // number of rows, which begin at the lower edge of the picture
    // Four numbers for each tile that may show something: x and y of its middle, from -1 to 1 over all tiles, and the
    // least and the greatest depth.
    points: Float32Array;
}

const sides = [16, 32, 64];
const mostColumns = 64;

// Returns true if a brick may show something. `leastShown` is the least shown code that is not clear.
const shows = (entry: number, leastShown: number): boolean => slotOf(entry) >= 0 && entry >>> 24 >= leastShown;

// Part of the picture that a box of drawn space covers, in pixels from the lower left, and the depths of the box.
interface Extent {
    left: number;
    right: number;
    low: number;
    high: number;
    near: number;
    far: number;
}

function extentOf(view: RayView, xs: readonly number[], ys: readonly number[], zs: readonly number[]): Extent {
    const { eye, right, up, forward, width, height } = view;
    const extent: Extent = {
        left: Infinity,
        right: -Infinity,
        low: Infinity,
        high: -Infinity,
        near: Infinity,
        far: -Infinity,
    };
    for (let corner = 0; corner < 8; ++corner) {
        const x = xs[corner & 1]! - eye[0];
        const y = ys[(corner >> 1) & 1]! - eye[1];
        const z = zs[corner >> 2]! - eye[2];
        const depth = x * forward[0] + y * forward[1] + z * forward[2];
        extent.near = Math.min(extent.near, depth);
        extent.far = Math.max(extent.far, depth);
        const scale = view.isPerspective ? view.focalPixels / depth : 1 / view.metersPerPixel;
        const across = 0.5 * width + scale * (x * right[0] + y * right[1] + z * right[2]);
        const upward = 0.5 * height + scale * (x * up[0] + y * up[1] + z * up[2]);
        extent.left = Math.min(extent.left, across);
        extent.right = Math.max(extent.right, across);
        extent.low = Math.min(extent.low, upward);
        extent.high = Math.max(extent.high, upward);
    }
    // A box that reaches behind the camera may be anywhere in the picture.
    if (view.isPerspective && extent.near <= 0)
        return { left: 0, right: width, low: 0, high: height, near: 0, far: extent.far };
    return extent;
}

// A box of blocks in a brick: x, y and z of its first block, and x, y and z of the block after its last.
type Blocks = [number, number, number, number, number, number];

// Returns the smallest box of blocks that holds all visible blocks of a slot; null if none is visible. If `blocks` is
// empty, as for a grid in parts, returns all blocks.
function shownBlocks(blocks: Uint8Array, slot: number, leastShown: number): Blocks | null {
    if (blocks.length === 0) return [0, 0, 0, blocksAlong, blocksAlong, blocksAlong];
    const found: Blocks = [blocksAlong, blocksAlong, blocksAlong, 0, 0, 0];
    for (let i = 0; i < blocksABrick; ++i) {
        if (blocks[blocksABrick * slot + i]! < leastShown) continue;
        const place = [i % blocksAlong, Math.floor(i / blocksAlong) % blocksAlong, Math.floor(i / blocksAlong ** 2)];
        for (let axis = 0; axis < 3; ++axis) {
            found[axis] = Math.min(found[axis]!, place[axis]!);
            found[axis + 3] = Math.max(found[axis + 3]!, place[axis]! + 1);
        }
    }
    return found[3] > 0 ? found : null;
}

type ShownAtlas = Pick<Atlas, 'bricks' | 'indirection' | 'blocks'>;

// Visits the visible box of blocks of each brick. `from` and `to` are the first block and the end, counted in blocks
// from the corner of the grid.
function eachShown(
    { bricks, indirection, blocks }: ShownAtlas,
    leastShown: number,
    visit: (from: Vec3, to: Vec3) => void,
): void {
    const [bx, by] = bricks;
    for (let i = 0; i < indirection.length; ++i) {
        if (!shows(indirection[i]!, leastShown)) continue;
        const found = shownBlocks(blocks, slotOf(indirection[i]!), leastShown);
        if (!found) continue;
        const [x, y, z] = [
            blocksAlong * (i % bx),
            blocksAlong * (Math.floor(i / bx) % by),
            blocksAlong * Math.floor(i / (bx * by)),
        ];
        visit([x + found[0], y + found[1], z + found[2]], [x + found[3], y + found[4], z + found[5]]);
    }
}

export function tilesOf(view: RayView, atlas: ShownAtlas, ends: BlockEnds, leastShown: number): Tiles {
    const { width, height } = view;
    const side = sides.find((one) => width <= one * mostColumns) ?? sides[sides.length - 1]!;
    const [columns, rows] = [Math.ceil(width / side), Math.ceil(height / side)];
    const near = new Float32Array(columns * rows).fill(Infinity);
    const far = new Float32Array(columns * rows).fill(-Infinity);
    eachShown(atlas, leastShown, (from, to) => {
        const extent = extentOf(
            view,
            [ends.x[from[0]]!, ends.x[to[0]]!],
            [ends.y[from[1]]!, ends.y[to[1]]!],
            [ends.z[from[2]]!, ends.z[to[2]]!],
        );
        if (view.isPerspective && extent.far <= 0) return;
        const lastColumn = Math.min(columns - 1, Math.floor(extent.right / side));
        const lastRow = Math.min(rows - 1, Math.floor(extent.high / side));
        for (let row = Math.max(0, Math.floor(extent.low / side)); row <= lastRow; ++row) {
            for (let column = Math.max(0, Math.floor(extent.left / side)); column <= lastColumn; ++column) {
                const tile = row * columns + column;
                near[tile] = Math.min(near[tile]!, extent.near);
                far[tile] = Math.max(far[tile]!, extent.far);
            }
        }
    });
    const points: number[] = [];
    for (let tile = 0; tile < near.length; ++tile) {
        if (near[tile]! > far[tile]!) continue;
        points.push(
            (2 * (tile % columns) + 1) / columns - 1,
            (2 * Math.floor(tile / columns) + 1) / rows - 1,
            near[tile]!,
            far[tile]!,
        );
    }
    return { side, columns, rows, points: new Float32Array(points) };
}

// Draws a point for each tile with the program in use.
export class TilePass {
    private array: WebGLVertexArrayObject | null = null;
    private buffer: WebGLBuffer | null = null;

    constructor(private gl: WebGL2RenderingContext) {}

    // Call after the context came back.
    forget(): void {
        this.array = this.buffer = null;
    }

    // Sets a larger viewport while it draws, because tiles at the right and the upper edge reach beyond the picture.
    draw({ width, height }: RayView, tiles: Tiles, program: Program): void {
        const { gl } = this;
        this.array ??= gl.createVertexArray();
        this.buffer ??= gl.createBuffer();
        gl.bindVertexArray(this.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
        gl.bufferData(gl.ARRAY_BUFFER, tiles.points, gl.STREAM_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
        program.float('side', tiles.side);
        gl.viewport(0, 0, tiles.columns * tiles.side, tiles.rows * tiles.side);
        gl.drawArrays(gl.POINTS, 0, tiles.points.length / 4);
        gl.viewport(0, 0, Math.ceil(width), Math.ceil(height));
        gl.bindVertexArray(null);
    }
}
