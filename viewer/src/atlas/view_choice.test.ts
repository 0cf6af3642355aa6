import assert from 'node:assert/strict';
import test from 'node:test';

import { Pyramid, pyramidOf } from './pyramid';
import { Placed, wantedColumns } from './view_choice';
import { ViewGeometry, heightRange, usualCamera } from '../camera/geometry';
import { readPackedGrid } from '../wire/packed_grid';
import { evenLevels, packedGrid } from '../testing/written_grid';

const [nx, ny] = [400, 320];
const levelsM = evenLevels(4);
const grid = readPackedGrid(packedGrid({ nx, ny, levelsM, codeOf: (x, y) => (x % 16 === 3 && y % 16 === 5 ? 40 : 1) }));
const pyramid: Pyramid = pyramidOf(grid);

function placed(zoom: number, fieldOfViewDeg = 0, tiltDeg = 0): Placed {
    const box = { halfXM: 500 * nx, halfYM: 500 * ny, ...heightRange(levelsM) };
    const camera = {
        ...usualCamera,
        azimuthDeg: 180,
        tiltDeg,
        zoom,
        fieldOfViewDeg,
        lookAtM: [0, 0, 1000] as [number, number, number],
    };
    return { geometry: new ViewGeometry(box, camera, 1, 200, 160), edge: 16, cellSizeM: [1000, 1000] };
}

test('a view of the whole takes cells about as wide as a pixel', () => {
    const wanted = wantedColumns(placed(1), pyramid, [0, 3], 1e6);
    assert(wanted.every(({ level }) => level === 0 || level === 1));
    assert(
        wanted.some(({ level }) => level === 0) !== wanted.some(({ level }) => level === 1),
        'from straight above, all columns have one level',
    );
});

test('a near view takes cells of the grid itself, of the visible part, from the middle outward', () => {
    const wanted = wantedColumns(placed(8), pyramid, [0, 3], 1e6);
    assert(wanted.length > 3 && wanted.length < 40);
    for (const { level, x, y } of wanted) {
        assert.equal(level, 0);
        assert(Math.abs(16 * x + 8 - nx / 2) < 50 && Math.abs(16 * y + 8 - ny / 2) < 50, `${x} ${y}`);
    }
    for (let i = 1; i < wanted.length; ++i) assert(wanted[i]!.away >= wanted[i - 1]!.away);
});

test('in perspective, far columns are coarser than near ones', () => {
    const wanted = wantedColumns(placed(1, 60, 80), pyramid, [0, 3], 1e6);
    const middleOf = ({ y, level }: { y: number; level: number }) => (y + 0.5) * 2 ** level;
    const mean = (list: number[]) => list.reduce((sum, one) => sum + one, 0) / list.length;
    const levels = [...new Set(wanted.map(({ level }) => level))].sort();
    assert(levels.length > 1);
    const south = (level: number) => mean(wanted.filter((one) => one.level === level).map(middleOf));
    assert(south(levels[0]!) < south(levels[levels.length - 1]!), 'columns in the south are nearer');
});

test('each place is covered once', () => {
    for (const view of [placed(1), placed(3, 40, 60), placed(20, 40, 70)]) {
        const seen = new Set<string>();
        for (const { level, x, y } of wantedColumns(view, pyramid, [0, 3], 1e6)) {
            for (let fx = x << level; fx < (x + 1) << level; ++fx)
                for (let fy = y << level; fy < (y + 1) << level; ++fy) {
                    assert(!seen.has(`${fx} ${fy}`));
                    seen.add(`${fx} ${fy}`);
                }
        }
    }
});

test('the wanted columns fit into the room', () => {
    for (const room of [300, 60, 10, 0]) {
        const bricks = wantedColumns(placed(2), pyramid, [0, 3], room)
            .filter(({ level }) => level < 3)
            .reduce(
                (sum, { level, x, y }) =>
                    sum + pyramid.levels[level]!.shown[x * pyramid.levels[level]!.columns[1] + y]!,
                0,
            );
        assert(bricks <= room);
    }
});

test('no column is finer than the finest allowed level', () => {
    assert(wantedColumns(placed(30), pyramid, [1, 3], 1e6).every(({ level }) => level === 1));
});

test('columns without values are not wanted', () => {
    const empty = pyramidOf(
        readPackedGrid(packedGrid({ nx: 64, ny: 64, levelsM, codeOf: (x, y) => (x < 3 && y < 3 ? 9 : 1) })),
    );
    const box = { halfXM: 32000, halfYM: 32000, ...heightRange(levelsM) };
    const geometry = new ViewGeometry(box, { ...usualCamera, tiltDeg: 0 }, 1, 800, 800);
    const wanted = wantedColumns({ geometry, edge: 16, cellSizeM: [1000, 1000] }, empty, [0, 2], 1e6);
    assert.deepEqual(wanted.map(({ key }) => key).sort(), ['0/0/0', '0/0/1', '0/1/0', '0/1/1']);
});
