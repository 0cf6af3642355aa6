import assert from 'node:assert/strict';
import test from 'node:test';

import { readCells } from './storm_cells';

const feature = (coordinates: unknown, properties: Record<string, unknown>) => ({
    type: 'Feature',
    geometry: { coordinates },
    properties,
});
const cell = (id: string, dbz: number, more: Record<string, unknown> = {}) =>
    feature([-97.25, 35.5], { kind: 'cell', id, max_dbz: dbz, top_m: 12000, top_is_at_least: true, ...more });

test('a cell has its attributes, its track and its forecast', () => {
    const cells = readCells({
        features: [
            cell('weak', 45),
            cell('strong', 61.5, { motion_east_mps: 10, motion_north_mps: 10, motion_error_mps: 1.5, mesh_mm: 30 }),
            feature(
                [
                    [-97.4, 35.4],
                    [-97.25, 35.5],
                ],
                { kind: 'track', id: 'strong' },
            ),
            feature(
                [
                    [-97.25, 35.5],
                    [-97.1, 35.6],
                ],
                {
                    kind: 'forecast',
                    id: 'strong',
                    minutes: [0, 15],
                    errors_m: [0, 1200],
                },
            ),
        ],
    });
    assert.deepEqual(
        cells.map((one) => one.id),
        ['strong', 'weak'],
    );
    const [strong, weak] = cells;
    assert.equal(strong!.fromDeg, 225);
    assert.equal(strong!.speedMps!.toFixed(2), '14.14');
    assert.equal(strong!.meshMm, 30);
    assert.equal(strong!.track.length, 2);
    assert.deepEqual(strong!.track[0], { latitudeDeg: 35.4, longitudeDeg: -97.4 });
    assert.deepEqual(strong!.ahead[1], {
        place: { latitudeDeg: 35.6, longitudeDeg: -97.1 },
        minutes: 15,
        errorM: 1200,
    });
    assert.equal(weak!.speedMps, null);
    assert.equal(weak!.meshMm, null);
    assert.equal(weak!.isTopAtLeast, true);
});

test('parts that make no sense are left out', () => {
    assert.deepEqual(readCells({}), []);
    assert.deepEqual(readCells({ features: 'many' }), []);
    assert.deepEqual(readCells({ features: [feature(null, { kind: 'cell', id: 'a' })] }), []);
    const [only] = readCells({
        features: [
            cell('a', NaN, { motion_east_mps: 'fast' }),
            feature([[1], null, [-97, 35]], { kind: 'track', id: 'a' }),
            feature([[-97, 35]], { kind: 'track', id: 'unknown' }),
        ],
    });
    assert.equal(only!.maxDbz, 0);
    assert.equal(only!.speedMps, null);
    assert.equal(only!.track.length, 1);
});
