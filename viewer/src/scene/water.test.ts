// Tests rings of land and lakes, and which of their edges are shores.

import assert from 'node:assert/strict';
import test from 'node:test';

import { isCut, mapLines, projected, withoutCuts } from './ground_lines';
import { planeOf } from '../earth/projection';
import { ringsOf } from './water';
import { MapLine } from '../wire/api';
import { placeAbout } from '../testing/written_grid';

const plane = planeOf(placeAbout([41, -75]));
const area = (kind: MapLine['kind'], ...points: [number, number][]): MapLine => ({ kind, is_area: true, points });
// Land in the west of a tile. Part of its shore is along a meridian that is not an edge of the tile.
const coast = area('coast', [-76, 40], [-75, 40], [-75, 40.5], [-74.8, 41.2], [-75, 42], [-76, 42], [-76, 40]);
const lake = area('lake', [-75.5, 41], [-75.3, 41], [-75.4, 41.1], [-75.5, 41]);
const all = projected({ credit: '', lines: [coast, lake], cities: [] }, plane);

test('edges of tiles are no shores, but other lines along a meridian are', () => {
    assert.deepEqual(
        coast.points.slice(1).map((_, i) => isCut(coast, i + 1)),
        [true, false, false, false, true, true],
    );
    assert.equal(withoutCuts(coast).length, 1);
    const lines = mapLines(all, 1e6);
    assert.equal(lines.find(({ kind }) => kind === 'coast')!.segments.length, 4 * 3);
    assert.equal(lines.find(({ kind }) => kind === 'lake')!.segments.length, 4 * 3);
});

test('long edges of tiles are divided, at the same places from both sides', () => {
    const [land] = ringsOf(all, 'coast', plane);
    const east = area('coast', [-76, 42], [-76, 40], [-78, 40], [-78, 42], [-76, 42]);
    const [neighbor] = ringsOf(projected({ credit: '', lines: [east], cities: [] }, plane), 'coast', plane);
    const west = ([x]: [number, number]) => x < plane.toPlane({ latitudeDeg: 41, longitudeDeg: -75.9 })![0];
    const shared = land!.filter(west).map(String);
    assert(shared.length >= 9, `${shared.length} points along two degrees`);
    const others = new Set(neighbor!.map(String));
    assert(shared.every((point) => others.has(point)));
    assert.equal(ringsOf(all, 'lake', plane).length, 1);
});
