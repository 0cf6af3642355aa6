import assert from 'node:assert/strict';
import test from 'node:test';

import { StormCell } from '../storm_cells';
import { usualUnits } from '../../tables/units';
import { columns, sortedCells } from './cell_table';

const cell = (id: string, more: Partial<StormCell>): StormCell => ({
    id,
    place: { latitudeDeg: 35, longitudeDeg: -97 },
    maxDbz: 50,
    topM: 12000,
    isTopAtLeast: false,
    vilKgM2: 30,
    meshMm: null,
    shearPerS: null,
    speedMps: null,
    fromDeg: null,
    speedErrorMps: null,
    track: [],
    ahead: [],
    ...more,
});
const column = (name: string): number => columns.findIndex((one) => one.name === name);
const ids = (cells: StormCell[]): string => cells.map((one) => one.id).join('');

test('cells are sorted by a column, unknown values last', () => {
    const cells = [
        cell('a', { maxDbz: 50, speedMps: 5 }),
        cell('b', { maxDbz: 60 }),
        cell('c', { maxDbz: 55, speedMps: 9 }),
    ];
    assert.equal(ids(sortedCells(cells, column('dBZ'), false)), 'bca');
    assert.equal(ids(sortedCells(cells, column('dBZ'), true)), 'acb');
    assert.equal(ids(sortedCells(cells, column('Speed'), false)), 'cab');
    assert.equal(ids(sortedCells(cells, column('Speed'), true)), 'acb');
    assert.equal(ids(cells), 'abc');
});

test('texts name units, errors and what is unknown', () => {
    const text = (name: string, one: StormCell) => columns[column(name)]!.text(one, usualUnits);
    assert.equal(text('Speed', cell('a', { speedMps: 15.2, speedErrorMps: 1.6 })), '15 ± 2 m/s');
    assert.equal(text('Speed', cell('a', {})), '–');
    assert.equal(text('MESH', cell('a', { meshMm: 41.6 })), '42');
    assert.equal(text('MESH', cell('a', {})), '–');
    assert.equal(text('Shear', cell('a', { shearPerS: 0.0123 })), '12.3');
    assert(text('Top', cell('a', { isTopAtLeast: true })).startsWith('> '));
});
