// Tests which windows of a grid in parts the page asks for, and that layers and readings of a window are the same as
// layers and readings of the whole grid.

import assert from 'node:assert/strict';
import test from 'node:test';

import type { Decoder } from './decoder';
import { Pyramid, pyramidOf } from './pyramid';
import { BrickWindow, boundsAbout, holds, windowAbout, windowQuery, windowSeen } from './window_choice';
import { ViewGeometry, usualCamera } from '../camera/geometry';
import { Ray } from '../camera/ray';
import { maximumField, planeField } from '../fields/flat_field';
import { cutSection } from '../fields/section';
import type { LoadedGrid } from './loaded_grid';
import { firstVisible, wayWithin } from '../scene/first_visible';
import { boxOf, extentOf, placingOf } from '../scene/grid_box';
import { cellSizeM, middleOn, planeOf } from '../earth/projection';
import { PackedGrid, readPackedGrid } from '../wire/packed_grid';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';

const made: Made = {
    nx: 150,
    ny: 101,
    levelsM: evenLevels(20),
    offsetCells: [3.5, -7],
    codeOf: (x, y, z) =>
        x > 40 && y < 80 && z < 15 && scrambled(x >> 2, y >> 2, z >> 1) % 3 === 0
            ? 3 + (scrambled(x, y, z) % 200)
            : x < 130
              ? 1
              : 0,
};
const grid = readPackedGrid(packedGrid(made));
const pyramid: Pyramid = pyramidOf(grid);
const plenty = { columns: 1e9, bytes: 1e9 };

// Cuts a window as the server does: each cell is the greatest of 2^level x 2^level cells.
function cut({ level, x, y }: BrickWindow): PackedGrid {
    const cell = 2 ** level;
    const [x0, y0] = [x[0] * 16, y[0] * 16];
    const along = (cells: number, [first, last]: [number, number]) =>
        Math.min(Math.ceil(cells / cell), (last + 1) * 16) - first * 16;
    const [nx, ny] = [along(made.nx, x), along(made.ny, y)];
    const offset = (axis: 0 | 1, cells: number, count: number, first: number) => {
        const center = (0.5 * (cells - 1) - made.offsetCells![axis] + 0.5) / cell - 0.5;
        return 0.5 * (count - 1) - (center - first);
    };
    const codeOf = (wx: number, wy: number, z: number) => {
        let most = 0;
        for (let ix = (x0 + wx) * cell; ix < Math.min(made.nx, (x0 + wx + 1) * cell); ++ix)
            for (let iy = (y0 + wy) * cell; iy < Math.min(made.ny, (y0 + wy + 1) * cell); ++iy)
                most = Math.max(most, made.codeOf(ix, iy, z));
        return most;
    };
    const offsetCells: [number, number] = [offset(0, made.nx, nx, x0), offset(1, made.ny, ny, y0)];
    return readPackedGrid(packedGrid({ ...made, nx, ny, spacing: 1000 * cell, offsetCells, halvings: level, codeOf }));
}
const cellsOf = (window: BrickWindow) => {
    const own = cut(window);
    return { grid: own, middle: middleOn(grid, own) };
};

function viewOf(zoom: number, tiltDeg: number, fieldOfViewDeg: number): ViewGeometry {
    return new ViewGeometry(
        boxOf(grid),
        { ...usualCamera, tiltDeg, zoom, fieldOfViewDeg, lookAtM: [10000, -8000, 1000] },
        2,
        300,
        240,
    );
}
const placed = (geometry: ViewGeometry) => ({ geometry, edge: 16, cellSizeM: cellSizeM(grid) });

test('a window has the same place on the plane as its cells in the grid', () => {
    for (const window of [
        { level: 0, x: [2, 5], y: [1, 3] },
        { level: 1, x: [1, 4], y: [0, 1] },
    ] as BrickWindow[]) {
        const { first, halvings } = placingOf(cellsOf(window), grid);
        const edge = 16 * 2 ** window.level;
        assert.equal(halvings, window.level);
        assert(
            Math.abs(first[0] - window.x[0] * edge) < 1e-6 && Math.abs(first[1] - window.y[0] * edge) < 1e-6,
            String(first),
        );
    }
    const all = extentOf({ grid, middle: [0, 0] });
    assert.deepEqual([all.westM, all.northM], [-75000, 50500]);
});

test('a view asks for its visible part, no finer than pixels show, within the limits', () => {
    for (const geometry of [viewOf(6, 0, 0), viewOf(6, 55, 40), viewOf(1, 0, 0)]) {
        const window = windowSeen(placed(geometry), pyramid, grid, plenty)!;
        const { westM, southM, eastM, northM } = extentOf(cellsOf(window));
        const pixels = [0, 150, 300].flatMap((x) => [0, 120, 240].map((y) => [x, y] as const));
        for (const [x, y] of pixels) {
            const at = geometry.ground(x, y);
            if (!at || Math.abs(at[0]) > 75000 || Math.abs(at[1]) > 50500) continue;
            assert(at[0] >= westM && at[0] <= eastM && at[1] >= southM && at[1] <= northM, `${at}`);
        }
    }
    const near = windowSeen(placed(viewOf(6, 0, 0)), pyramid, grid, plenty)!;
    assert.equal(near.level, 0);
    assert((near.x[1] - near.x[0] + 1) * (near.y[1] - near.y[0] + 1) < 20, 'few of the 70 columns of bricks');
    const small = windowSeen(placed(viewOf(6, 0, 0)), pyramid, grid, { columns: 1e9, bytes: 30000 })!;
    assert(small.level > 0);
    const coarse = windowSeen(placed(viewOf(6, 0, 0)), pyramid, grid, { columns: 16 * 16 * 6, bytes: 1e9 })!;
    assert((coarse.x[1] - coarse.x[0] + 1) * (coarse.y[1] - coarse.y[0] + 1) <= 6);
    const away = new ViewGeometry(
        boxOf(grid),
        { ...usualCamera, tiltDeg: 0, zoom: 20, lookAtM: [9e6, 0, 0] },
        1,
        300,
        240,
    );
    assert.equal(windowSeen(placed(away), pyramid, grid, plenty), null);
});

test('a window inside of one that has come is not asked for again', () => {
    const window: BrickWindow = { level: 1, x: [1, 4], y: [0, 2] };
    assert(holds(window, { level: 1, x: [2, 4], y: [0, 0] }));
    assert(!holds(window, { level: 1, x: [2, 5], y: [0, 0] }) && !holds(window, { level: 0, x: [2, 4], y: [0, 0] }));
    assert.deepEqual(windowQuery(window), { half: '1', by: 'maximum', window: '1-4,0-2' });
    assert.deepEqual(windowQuery({ level: 0, x: [3, 3], y: [0, 9] }), { window: '3-3,0-9' });
});

test('a window and its grid have the same flat layers', () => {
    const window: BrickWindow = { level: 0, x: [2, 6], y: [1, 4] };
    const part = cut(window);
    for (const [one, other] of [
        [planeField(grid, 'REF', 3200)!, planeField(part, 'REF', 3200)!],
        [maximumField(grid), maximumField(part)],
    ] as const) {
        let values = 0;
        for (let y = 0; y < other.height; ++y) {
            for (let x = 0; x < other.width; ++x) {
                const [at, from] = [y * other.width + x, (y + 16) * one.width + x + 32];
                assert.deepEqual([other.states[at], other.values[at]], [one.states[from], one.values[from]]);
                values += other.states[at] === 3 ? 1 : 0;
            }
        }
        assert(values > 500);
    }
});

test('a window about a line gives the same section as the grid', () => {
    const plane = planeOf(grid);
    const [from, to] = [plane.toPlace([-30000, -20000]), plane.toPlace([40000, 20000])];
    const points = [plane.toPlane(from)!, plane.toPlane(to)!];
    const window = windowAbout(boundsAbout(points, grid)!, 0, 1, pyramid, grid, plenty);
    assert((window.x[1] - window.x[0] + 1) * (window.y[1] - window.y[0] + 1) < 40);
    const whole = cutSection(grid, 'REF', from, to, 200, 60);
    const cells = cellsOf(window);
    const part = cutSection(cells.grid, 'REF', from, to, 200, 60);
    assert.deepEqual([...part.field.states], [...whole.field.states]);
    assert.deepEqual([...part.field.values], [...whole.field.values]);
    assert(
        part.ends.every(
            ([x, y], i) =>
                Math.hypot(x + cells.middle[0] - whole.ends[i]![0], y + cells.middle[1] - whole.ends[i]![1]) < 0.01,
        ),
    );
    assert.equal(
        boundsAbout(
            [
                [9e5, 0],
                [8e5, 10],
            ],
            grid,
        ),
        null,
    );
});

test('a ray meets the same cells in its window as in the grid', () => {
    const geometry = viewOf(3, 60, 40);
    const { halfXM, halfYM, bottomM, topM } = boxOf(grid);
    const box = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
    let met = 0;
    for (let x = 7; x < 300; x += 23) {
        for (let y = 5; y < 240; y += 19) {
            const ray = new Ray(geometry, x, y);
            const way = wayWithin(ray, box);
            if (!way) continue;
            const bounds = boundsAbout(way, grid)!;
            const cells = cellsOf(windowAbout(bounds, 0, 1, pyramid, grid, plenty));
            const [one, other] = [{ grid, middle: [0, 0] as [number, number] }, cells].map((of) =>
                firstVisible(of, ray, box, (value) => value > 10),
            );
            assert.equal(other?.value, one?.value);
            if (one) ++met;
        }
    }
    assert(met > 20);
});

// 2026-11-28: after one failed answer, a plane stayed empty, as if there were no storm.
test('a window that failed is asked for again, and a frame waits for it', async () => {
    Object.assign(globalThis, { document: { baseURI: 'http://localhost/view/' } });
    const { Windows } = await import('../page/windows');
    const statuses = [500, 500, 200, 410];
    const seconds: number[] = [];
    Object.assign(globalThis, {
        fetch: (): Promise<Response> =>
            Promise.resolve(
                new Response('{"error":"trouble"}', {
                    status: statuses.shift()!,
                    headers: { 'Stormcellar-Status': '' },
                }),
            ),
        setTimeout: (act: () => void, ms: number) => {
            seconds.push(ms / 1000);
            queueMicrotask(act);
        },
    });
    const decoder = { ask: () => Promise.resolve({ grid }) } as unknown as Decoder;
    const failures: string[] = [];
    const windows = new Windows(
        decoder,
        () => 256e6,
        () => undefined,
        (error) => void failures.push(String(error)),
    );
    const loadedNow = (): LoadedGrid =>
        ({ grid, stream: { domain: 'D', moment: 'REF', time: 'T', pyramid } }) as unknown as LoadedGrid;
    const seen = (loaded: LoadedGrid) => windows.seen(loaded, 'layers', viewOf(1, 0, 0), false);

    const first = loadedNow();
    const next = windows.next(first, () => seen(first))!;
    seen(first);
    assert(windows.isWaiting);
    await next;
    assert.deepEqual([windows.isWaiting, seen(first)?.grid === grid], [false, true]);
    // 2026-11-29: the page said that a whole grid was as coarse as the grid in parts that it showed before.
    const coarse = { ...grid, halvings: 2 };
    windows.seen({ grid: coarse, stream: null } as unknown as LoadedGrid, 'layers', viewOf(1, 0, 0), false);
    const other = { grid, stream: null } as unknown as LoadedGrid;
    assert.deepEqual(
        [
            windows.coarsest(other),
            windows.halvings(other, 'layers'),
            windows.halvings({ ...other, grid: coarse }, 'ray'),
        ],
        [0, 0, 2],
    );
    assert.deepEqual(
        [failures, seconds],
        [
            ['Error: trouble', 'Error: trouble'],
            [3, 3],
        ],
    );

    const gone = loadedNow();
    let error = '';
    await windows.next(gone, () => seen(gone))!.catch((one: unknown) => (error = String(one)));
    seen(gone);
    assert.deepEqual([error, windows.isWaiting, statuses], ['Error: trouble', true, []]);
});
