import assert from 'node:assert/strict';
import test from 'node:test';

import { makeAtlas } from '../atlas/atlas';
import { ViewGeometry, usualCamera } from '../camera/geometry';
import { boxOf } from '../scene/grid_box';
import { blockEnds, tilesOf } from './echo_tiles';
import { cornersOf, trianglesOf } from './line_pass';
import { readPackedGrid } from '../wire/packed_grid';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';

const made: Made = {
    nx: 150,
    ny: 100,
    levelsM: evenLevels(40),
    // Echo in two towers. The second tower is weak.
    codeOf: (x, y) => (x > 30 && x < 36 && y > 40 && y < 50 ? 150 : x > 100 && x < 108 && y > 20 && y < 24 ? 40 : 1),
};
const grid = readPackedGrid(packedGrid(made));
const atlas = makeAtlas(grid, 2048);
const exaggeration = 3;

function viewOf(
    azimuthDeg: number,
    tiltDeg: number,
    zoom: number,
    fieldOfViewDeg: number,
    lookAtM: [number, number, number] | null = null,
): ViewGeometry {
    return new ViewGeometry(
        boxOf(grid),
        { ...usualCamera, azimuthDeg, tiltDeg, zoom, fieldOfViewDeg, lookAtM },
        exaggeration,
        411,
        273,
    );
}

// Returns the greatest code of a value that the ray's sample at a depth uses; 0 without values, and outside of the box.
function codeAt(view: ViewGeometry, x: number, y: number, depth: number): number {
    const [px, py, pz] = view.point(x, y, depth);
    const { halfXM, halfYM, bottomM, topM } = view.box;
    if (Math.abs(px) > halfXM || Math.abs(py) > halfYM || pz < bottomM * exaggeration || pz > topM * exaggeration)
        return 0;
    const level = (pz / exaggeration - grid.levelsM[0]!) / (grid.levelsM[1]! - grid.levelsM[0]!);
    const place = [px / 1000 + 0.5 * (grid.nx - 1), py / 1000 + 0.5 * (grid.ny - 1), level];
    let greatest = 0;
    for (let i = 0; i < 8; ++i) {
        const cell = place.map((at, axis) => {
            const last = [grid.nx, grid.ny, grid.nz][axis]! - 1;
            return Math.min(last, Math.floor(Math.min(last, Math.max(0, at))) + ((i >> axis) & 1));
        });
        const code = made.codeOf(cell[0]!, cell[1]!, cell[2]!);
        if (code >= 3) greatest = Math.max(greatest, code);
    }
    return greatest;
}

const views = [
    viewOf(180, 55, 1, 40),
    viewOf(30, 80, 2, 40),
    viewOf(200, 0, 1, 0),
    viewOf(100, 60, 3, 0, [-40e3, -5e3, 3e3]),
    viewOf(250, 85, 12, 60, [-42e3, -5e3, 5e3]), // the camera is within the box
];

test('each ray meets visible values only in a tile and between the depths of this tile', () => {
    let [met, all] = [0, 0];
    for (const leastShown of [1, 100]) {
        for (const view of views) {
            const { side, columns, points } = tilesOf(view, atlas, blockEnds(grid, view), leastShown);
            const depths = new Map<number, [number, number]>();
            const rows = Math.ceil(view.height / side);
            for (let i = 0; i < points.length; i += 4) {
                const column = Math.floor(((points[i]! + 1) / 2) * columns);
                const row = Math.floor(((points[i + 1]! + 1) / 2) * rows);
                depths.set(row * columns + column, [points[i + 2]!, points[i + 3]!]);
            }
            for (let i = 0; i < 20000; ++i) {
                const part = (k: number) => scrambled(i, k, 3) / 2 ** 32;
                const [x, y] = [Math.floor(part(1) * view.width) + 0.5, Math.floor(part(2) * view.height) + 0.5];
                const depth = view.nearM + part(3) * (view.farM - view.nearM);
                ++all;
                if (codeAt(view, x, y, depth) < leastShown) continue;
                const tile = Math.floor((view.height - y) / side) * columns + Math.floor(x / side);
                const [near, far] = depths.get(tile) ?? [Infinity, -Infinity];
                const slack = 1e-6 * view.farM;
                assert(near <= depth + slack && depth <= far + slack, `pixel ${x} ${y}, depth ${depth}`);
                ++met;
            }
        }
    }
    assert(met > 300 && met < all / 4, `${met} of ${all}`);
});

test('most of a picture with little echo has no tiles', () => {
    const view = views[0]!;
    const { columns, rows, points } = tilesOf(view, atlas, blockEnds(grid, view), 1);
    assert(points.length / 4 < 0.4 * columns * rows, `${points.length / 4} of ${columns * rows}`);
    const strong = tilesOf(view, atlas, blockEnds(grid, view), 100);
    assert(strong.points.length < points.length, 'hidden weak echo has no tiles');
});

test('tiles cover all of a small picture if they cover the whole picture of the same view', () => {
    const full = readPackedGrid(packedGrid({ ...made, codeOf: () => 90 }));
    const view = viewOf(180, 0, 4, 0);
    const small = Object.assign({}, view, {
        width: view.width / 5,
        height: view.height / 5,
        metersPerPixel: view.metersPerPixel * 5,
        isPerspective: false,
    });
    const { columns, rows, points } = tilesOf(small, makeAtlas(full, 2048), blockEnds(full, view), 1);
    assert.equal(points.length / 4, columns * rows);
    assert.equal(columns, Math.ceil(411 / 5 / 16));
});

test('each segment of a line has four corners that know both of its ends, and two triangles', () => {
    const corners = cornersOf(new Float32Array([1, 2, 3, 4, 5, 6, 7, 8]));
    assert.equal(corners.length, 2 * 4 * 4);
    assert.deepEqual([...corners.slice(12, 20)], [1, 2, 3, 4, 5, 6, 7, 8]);
    const triangles = [...trianglesOf(2)];
    assert.equal(triangles.length, 12);
    for (const [i, corner] of triangles.entries()) assert.equal(Math.floor(corner / 4), Math.floor(i / 6));
    assert.deepEqual(
        [...new Set(triangles)].sort((a, b) => a - b),
        [0, 1, 2, 3, 4, 5, 6, 7],
    );
});
