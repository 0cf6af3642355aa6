// Tests that ambiguous cells and gates keep their state from the bytes of the server to each reading, and never become
// values.

import assert from 'node:assert/strict';
import test from 'node:test';

import { makeAtlas, rangeOfCodes } from '../atlas/atlas';
import { countCodes } from '../atlas/histogram';
import { bricksShown, pyramidOf } from '../atlas/pyramid';
import { ViewGeometry, usualCamera } from '../camera/geometry';
import { Ray } from '../camera/ray';
import { planeOf } from '../earth/projection';
import { fallsOf } from '../fields/falls';
import { FlatField, maximumField, planeField } from '../fields/flat_field';
import { cutSection, greatestOf } from '../fields/section';
import { Mixer } from '../fields/status_rule';
import { firstVisible, mostVisible } from '../scene/first_visible';
import { boxOf } from '../scene/grid_box';
import { fieldAt } from '../scene/solid_hits';
import { Made, evenLevels, packedGrid, scrambled } from '../testing/written_grid';
import { derivedOf, measuredOf, momentsInOrder, tablesOf, titleOf } from '../wire/moments';
import { CellState, codeAt, readPackedGrid, stateOf, valueOf } from '../wire/packed_grid';
import { stateOfGate } from '../wire/packed_sweep';
import { readColumn } from './column_reading';

const [vel, veld] = [1, 7];
const zero = 4099; // code of 0 m/s

// A grid of VELD whose values are from -50 to 50 m/s. A third of its cells is ambiguous, and another third no echo.
const made: Made = {
    nx: 40,
    ny: 36,
    levelsM: evenLevels(20),
    moment: veld,
    codeBytes: 2,
    firstValue: -1024,
    step: 0.25,
    codeOf: (x, y, z) => {
        const drawn = scrambled(x, y, z);
        return [3, 1, zero - 200 + (drawn % 401)][Math.floor(drawn / 512) % 3]!;
    },
};
const bytes = packedGrid(made);
const grid = readPackedGrid(bytes);
const isPlausible = (value: number) => Math.abs(value) <= 50;

function checkField(field: FlatField, what: string): void {
    let [values, ambiguous] = [0, 0];
    field.states.forEach((state, at) => {
        if (state === CellState.value) ++values;
        if (state === CellState.ambiguous) ++ambiguous;
        if (state === CellState.value) assert.ok(isPlausible(field.values[at]!), `${what}: ${field.values[at]}`);
        else assert.equal(field.values[at], 0);
    });
    assert.ok(values > 100, what);
    if (what !== 'maximum') assert.ok(ambiguous > 100, what);
}

test('code 3 is ambiguous in a grid of a derived moment, and a value in any other', () => {
    const measured = readPackedGrid(packedGrid({ ...made, moment: vel }));
    assert.deepEqual([grid.firstCode, measured.firstCode], [4, 3]);
    const states = [0, 1, 2, 3, 4].map((code) => [stateOf(grid, code), stateOf(measured, code)]);
    assert.deepEqual(states, [
        [CellState.notSeen, CellState.notSeen],
        [CellState.noEcho, CellState.noEcho],
        [CellState.rangeFolded, CellState.rangeFolded],
        [CellState.ambiguous, CellState.value],
        [CellState.value, CellState.value],
    ]);
    assert.equal(valueOf(grid, zero), 0);
});

test('ambiguous and range folded weigh together, and the heavier one is the state', () => {
    const mixer = new Mixer('mean');
    const mixed = (...parts: [CellState, number, number][]): [CellState, number] => {
        mixer.clear();
        for (const part of parts) mixer.add(...part);
        mixer.result();
        return [mixer.state, mixer.value];
    };
    const [noEcho, rangeFolded] = [CellState.noEcho, CellState.rangeFolded];
    const [value, ambiguous] = [CellState.value, CellState.ambiguous];
    assert.deepEqual(mixed([ambiguous, -1024, 0.4], [value, 40, 0.6]), [value, 40]);
    assert.deepEqual(mixed([ambiguous, -1024, 0.6], [value, 40, 0.4]), [ambiguous, 0]);
    assert.deepEqual(mixed([ambiguous, 0, 0.35], [rangeFolded, 0, 0.25], [value, 40, 0.4]), [ambiguous, 0]);
    assert.deepEqual(mixed([ambiguous, 0, 0.25], [rangeFolded, 0, 0.35], [value, 40, 0.4]), [rangeFolded, 0]);
    assert.deepEqual(mixed([ambiguous, 0, 0.4], [noEcho, 0, 0.6]), [noEcho, 0]);
});

test('planes, sections and maxima keep ambiguous cells apart from values', () => {
    checkField(planeField(grid, 'VELD', 3000)!, 'plane at a level');
    const between = planeField(grid, 'VELD', 3200)!;
    checkField(between, 'plane between levels');
    checkField(maximumField(grid), 'maximum');
    const alone = readPackedGrid(packedGrid({ ...made, codeOf: (x) => (x < 20 ? 3 : 2) }));
    assert.deepEqual([...new Set(maximumField(alone).states)].sort(), [CellState.rangeFolded, CellState.ambiguous]);
    const plane = planeOf(grid);
    const section = cutSection(grid, 'VELD', plane.toPlace([-15000, 0]), plane.toPlace([15000, 500]), 200, 90);
    checkField(section.field, 'section');
    assert.ok(isPlausible(greatestOf(section)!.value));
    for (let i = 0; i < 500; ++i) {
        const { state, value } = fieldAt(between, (i * 7.3) % 40, (i * 3.7) % 36, true);
        assert.ok(isPlausible(value) && (value === 0 || state === CellState.value));
    }
});

test('the volume does not show ambiguous cells, and its codes span the values alone', () => {
    const atlas = makeAtlas(grid, 2048);
    const codes = new Set<number>();
    let counted = 0;
    for (let z = 0; z < grid.nz; ++z)
        for (let y = 0; y < grid.ny; ++y)
            for (let x = 0; x < grid.nx; ++x) {
                const code = codeAt(grid, x, y, z);
                if (code >= 4) ++counted;
                if (code >= 4) codes.add(code);
            }
    assert.deepEqual([atlas.least, atlas.greatest], [Math.min(...codes), Math.max(...codes)]);
    assert.ok(atlas.codeScale < 1.6, 'a step of eight bits is at most 0.4 m/s');
    assert.equal(
        atlas.histogram.reduce((sum, one) => sum + one, 0),
        counted,
    );
    assert.equal(
        countCodes(grid, atlas).reduce((sum, one) => sum + one, 0),
        counted,
    );
    const onlyAmbiguous = readPackedGrid(packedGrid({ ...made, codeOf: () => 3 }));
    const empty = makeAtlas(onlyAmbiguous, 2048);
    assert.equal(empty.brickCount, 0);
    assert.equal(bricksShown(pyramidOf(onlyAmbiguous).levels[0]!), 0);
    const falls = fallsOf(onlyAmbiguous, 'VELD', -50);
    assert.ok(falls.bytes.every((byte, i) => byte === (i % 4 === 3 ? 0 : 128)));
});

test('the table of a grid in parts bounds its codes by the greatest value to both sides of zero', () => {
    const [, greatest] = rangeOfCodes(grid);
    const table = { ...grid, codes: new Uint16Array(0) };
    assert.deepEqual(rangeOfCodes(table), [2 * zero - greatest, greatest]);
});

test('a ray passes ambiguous cells, and a column tells them', () => {
    const { halfXM, halfYM, bottomM, topM } = boxOf(grid);
    const box = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
    const cells = { grid, middle: [0, 0] as [number, number] };
    const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, tiltDeg: 50 }, 2, 200, 200);
    let seen = 0;
    for (let i = 0; i < 200; ++i) {
        const ray = new Ray(geometry, 60 + ((i * 7) % 80), 70 + ((i * 3) % 60));
        const first = firstVisible(cells, ray, box, (value) => value < -45);
        const most = mostVisible(cells, ray, box, Infinity, (value) => (value < -45 ? 1e-3 : 0));
        for (const hit of [first, most.cell]) {
            if (hit) ++seen;
            if (hit) assert.ok(isPlausible(hit.value), `${hit.value}`);
        }
    }
    assert.ok(seen > 100, `${seen}`);
    const { levels, greatest } = readColumn(grid, 7, 9);
    levels.forEach(({ state, value }, z) => {
        const code = codeAt(grid, 7, 9, z);
        assert.equal(state, stateOf(grid, code));
        assert.equal(value, code >= 4 ? valueOf(grid, code) : null);
    });
    assert.ok(levels.some(({ state }) => state === CellState.ambiguous) && isPlausible(greatest!.value));
});

test('a gate has the state of its code: in VELD, 1 is range folded and 2 is ambiguous; in VEL, 2 is a value', () => {
    const derived = { firstValueCode: 3, ambiguousCode: 2 };
    const [noEcho, rangeFolded] = [CellState.noEcho, CellState.rangeFolded];
    const [value, ambiguous] = [CellState.value, CellState.ambiguous];
    const states = (of: typeof derived) => [0, 1, 2, 3].map((code) => stateOfGate(of, code));
    assert.deepEqual(states(derived), [noEcho, rangeFolded, ambiguous, value]);
    assert.deepEqual(states({ firstValueCode: 2, ambiguousCode: -1 }), [noEcho, rangeFolded, value, value]);
    assert.equal(stateOfGate({ firstValueCode: 8, ambiguousCode: -1 }, 7), noEcho, 'code 7 is a flag of CFP');
});

test('the dealiased velocity follows the measured velocity, even if the server has no grids of VELD', () => {
    assert.deepEqual(
        [derivedOf('VEL'), derivedOf('REF'), measuredOf('VELD'), measuredOf('ABC')],
        ['VELD', null, 'VEL', 'ABC'],
    );
    assert.deepEqual(['REF', 'VELD', 'AZSH', 'DIVG', 'ABC'].map(tablesOf), ['REF', 'VEL', 'AZSH', 'AZSH', 'ABC']);
    assert.deepEqual([titleOf('VELD'), titleOf('ABC')], ['Dealiased velocity', 'ABC']);
    const names = (there: string[]) =>
        momentsInOrder(there).map((one) => one.moment + (one.isThere ? '' : ' (not there)'));
    assert.deepEqual(names(['REF', 'VEL', 'SW', 'VELD']), ['REF', 'VEL', 'VELD', 'SW']);
    assert.deepEqual(names(['REF', 'VEL']), ['REF', 'VEL', 'VELD (not there)']);
    assert.deepEqual(names(['REF']), ['REF']);
    assert.deepEqual(names(['VEL', 'VELD', 'SRV', 'AZSH']), ['VEL', 'VELD', 'SRV', 'AZSH']);
    assert.deepEqual(names(['VELD']), ['VELD']);
});
