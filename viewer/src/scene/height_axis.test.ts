import assert from 'node:assert/strict';
import test from 'node:test';

import { ViewGeometry, usualCamera } from '../camera/geometry';
import { heightAxis } from './height_axis';
import { knownUnits } from '../tables/units';

const box = { halfXM: 200000, halfYM: 200000, bottomM: 500, topM: 17000 };
const [km, kft, feet] = knownUnits.height as unknown as [
    (typeof knownUnits.height)[0],
    (typeof knownUnits.height)[0],
    (typeof knownUnits.height)[0],
];
const viewOf = (more: object) =>
    new ViewGeometry(box, { ...usualCamera, fieldOfViewDeg: 40, tiltDeg: 60, ...more }, 5, 796, 532);
const inPicture = (x: number, y: number) => x > 0 && y > 0 && x < 796 && y < 532;

test('the axis is over a corner of the grid, with marks at round heights', () => {
    const geometry = viewOf({});
    const axis = heightAxis(geometry, km, 1, inPicture)!;
    const corners = [-1, 1].flatMap((x) => [-1, 1].map((y) => geometry.project([x * box.halfXM, y * box.halfYM, 0])!));
    assert(corners.some(([x, y]) => Math.hypot(x - axis.foot[0], y - axis.foot[1]) < 1e-6));
    assert.deepEqual(
        axis.marks.map(({ number }) => number),
        [0, 5, 10, 15],
    );
    assert(axis.marks.every(({ at }, i) => i === 0 || at[1] < axis.marks[i - 1]!.at[1] - 10));
    assert(heightAxis(geometry, kft, 1, inPicture)!.marks.every(({ number }) => number % 10 === 0 && number <= 56));
    assert.equal(heightAxis(geometry, feet, 1, inPicture)!.marks[1]!.number % 1000, 0);
});

test('a view from above has no axis, and in a near view the axis ends at the edge of the picture', () => {
    assert.equal(heightAxis(viewOf({ tiltDeg: 0 }), km, 1, inPicture), null);
    const near = heightAxis(viewOf({ zoom: 8, tiltDeg: 75, lookAtM: [0, 0, 3000] }), km, 1, inPicture)!;
    assert(inPicture(...near.head) && near.marks[near.marks.length - 1]!.number < 17);
    assert.equal(
        heightAxis(viewOf({}), km, 1, () => false),
        null,
    );
});
