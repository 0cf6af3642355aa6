import assert from 'node:assert/strict';
import test from 'node:test';

import { elsewhere, switched } from './flat_view';
import { paneAt, panePlaces } from './pane_places';
import { PaneView, allPanes, paneList, panesOfMoments, panesOfTilts, presetMoments, withPanes } from './panes';
import { ViewState, addressOf, stateOf, usualState } from './view_state';

const one: ViewState = { ...usualState, domain: 'KLBB', moment: 'REF' };
const { layers } = usualState;
const velocity: PaneView = {
    moment: 'VEL',
    layers: { ...layers, sweepDeg: 0.5, isSweepDealiased: true, surface: { value: -20, moment: 'ZDR' } },
    least: -12.5,
    colors: 'a=b;c&d%e+f g',
};
const withTwo = (active: number): ViewState => ({ ...one, ...withPanes([allPanes(one)[0]!, velocity], active) });

test('the address holds all panes and the active one', () => {
    for (const active of [0, 1]) {
        const read = stateOf(`#${addressOf(withTwo(active))}`);
        assert.deepEqual(allPanes(read), allPanes(withTwo(active)));
        assert.deepEqual([read.active, read.moment], [active, active === 0 ? 'REF' : 'VEL']);
    }
    assert.ok(/moment=REF&.*&pane=VEL;least=-12\.5;colors=/.test(addressOf(withTwo(0))));
});

test('a view with one pane has the address that it had before there were panes', () => {
    assert.equal(/pane|active/.test(addressOf(one)), false);
    assert.deepEqual(stateOf(`#${addressOf(one)}`), one);
});

test('a link shows 1, 2 or 4 panes, and what makes no sense is left out', () => {
    const count = (text: string) => allPanes(stateOf(text)).length;
    const counts = ['', '&pane=VEL', '&pane=VEL&pane=ZDR', '&pane=A&pane=B&pane=C', '&pane=A&pane=B&pane=C&pane=D'];
    assert.deepEqual(
        counts.map((panes) => count(`#moment=REF${panes}`)),
        [1, 2, 2, 4, 4],
    );
    for (const active of ['0', '3', '-1', '1.5', 'x', ''])
        assert.equal(stateOf(`#moment=REF&pane=VEL&active=${active}`).active, 0, active);
    const [, pane] = allPanes(stateOf('#moment=REF&pane=vel;elevation=200;least=x;crop-km=1;maximum=1;<b>'));
    assert.deepEqual(pane, { moment: 'VEL', layers: { ...layers, hasMaximum: true }, least: null, colors: '' });
});

test('in 2D, a pane shows the lowest tilt if the address names none', () => {
    const [first, second] = allPanes(stateOf('#view=2d&moment=REF&elevation=2.4&pane=VEL'));
    assert.deepEqual([first!.layers.sweepDeg, second!.layers.sweepDeg], [2.4, 0.5]);
    assert.deepEqual([first!.layers.hasVolume, second!.layers.hasVolume], [false, false]);
});

test('fewer panes keep the active one, and more panes repeat it', () => {
    const moments = (all: PaneView[]) => all.map(({ moment }) => moment);
    assert.deepEqual(moments(paneList(withTwo(1), 1)), ['VEL']);
    assert.deepEqual(moments(paneList(withTwo(0), 1)), ['REF']);
    assert.deepEqual(moments(paneList(withTwo(1), 4)), ['REF', 'VEL', 'VEL', 'VEL']);
});

test('the preset takes other moments for those that the domain lacks', () => {
    const usual = ['REF', 'VEL', 'ZDR', 'RHO'];
    assert.deepEqual(presetMoments(4, ['REF', 'VEL', 'SW', 'ZDR', 'PHI', 'RHO'], usual), ['REF', 'VEL', 'ZDR', 'RHO']);
    assert.deepEqual(presetMoments(4, ['SW', 'VEL', 'REF'], usual), ['REF', 'VEL', 'SW', 'REF']);
    const panes = panesOfMoments({ ...one, least: 20 }, ['REF', 'VEL']);
    assert.deepEqual(
        panes.map(({ least }) => least),
        [20, null],
        'a threshold is in the unit of its moment',
    );
    const tilts = panesOfTilts(one, [0.5, 1.3]);
    assert.deepEqual(
        tilts.map((pane) => [pane.layers.sweepDeg, pane.layers.hasVolume]),
        [
            [0.5, false],
            [1.3, false],
        ],
    );
});

test('layers of all panes change with 2D and 3D, and come back', () => {
    const solid = withTwo(0);
    const flat = switched(solid, true, null);
    assert.ok(allPanes(flat).every((pane) => !pane.layers.hasVolume && pane.layers.sweepDeg !== null));
    const other = { ...flat, ...withPanes(allPanes(flat), 1) };
    const back = switched(other, false, solid);
    assert.deepEqual(allPanes(back), allPanes(solid), 'also if another pane became active');
    assert.equal(back.active, 1);
    const fewer = { ...flat, ...withPanes(paneList(flat, 1), 0) };
    assert.equal(allPanes(switched(fewer, false, solid)).length, 1);
});

test('another domain has other places in all panes', () => {
    const section = [
        { latitudeDeg: 35, longitudeDeg: -97 },
        { latitudeDeg: 36, longitudeDeg: -97 },
    ] as const;
    const state = { ...one, ...withPanes([allPanes(one)[0]!, { ...velocity, layers: { ...layers, section } }], 0) };
    assert.ok(allPanes({ ...state, ...elsewhere(state) }).every((pane) => pane.layers.section === null));
});

test('panes have the same size and do not overlap', () => {
    assert.deepEqual(panePlaces(1, 801, 600, 2), [{ left: 0, top: 0, width: 801, height: 600 }]);
    assert.deepEqual(
        panePlaces(2, 801, 600, 2).map(({ left, width }) => [left, width]),
        [
            [0, 399],
            [401, 399],
        ],
    );
    assert.deepEqual(
        panePlaces(2, 390, 700, 2).map(({ top, height }) => [top, height]),
        [
            [0, 349],
            [351, 349],
        ],
    );
    const four = panePlaces(4, 801, 601, 3);
    assert.ok(four.every(({ width, height }) => width === 399 && height === 299));
    for (const [i, { left, top, width, height }] of four.entries()) {
        assert.equal(paneAt(four, left + 1, top + 1), i);
        assert.equal(paneAt(four, left + width, top + height), i, 'the nearest pane');
    }
    assert.ok(panePlaces(4, 1, 1, 2).every(({ width }) => width >= 16));
});
