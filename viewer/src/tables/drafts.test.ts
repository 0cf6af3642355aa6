import assert from 'node:assert/strict';
import test from 'node:test';

import { colorOf, extinctionPerM } from './color_table';
import { Draft, draftOf, fileOf, perKmAt, tableForPal, tableOf } from './draft';
import {
    withColor,
    withColorAdded,
    withColorMoved,
    withColorRemoved,
    withOpacityAdded,
    withOpacityMoved,
    withOpacityRemoved,
} from './draft_edits';
import { draftOfText, textOfDraft } from './draft_text';
import { History } from './history';
import { readPal, writePal } from './pal_file';
import { cornersToKeep } from './simplify';
import { tableOfFile } from './table_file';
import { readToml } from './toml_file';
import { writeToml } from './toml_writer';
import { smooth, usual } from '../testing/made_tables';

const draft = draftOf(smooth, 'REF', usual);
const opaque: Draft = {
    ...draft,
    opacity: [
        { value: 10, perKm: 0 },
        { value: 40, perKm: 2 },
    ],
};

const edged: Draft = {
    ...opaque,
    colors: [
        { value: 5, color: [0, 0, 0, 255] },
        { value: 30, color: [100, 100, 100, 255] },
        { value: 30, color: [0, 0, 200, 255] },
        { value: 60, color: [255, 255, 255, 255] },
    ],
};

test('a draft has few points and looks like its table', () => {
    assert.deepEqual(
        draft.colors.map((point) => point.value),
        [5, 35, 65],
        'the point on the line is left out',
    );
    assert.equal(draft.opacity, null, 'the opacity is the usual opacity');
    const table = tableOf(draft, usual);
    for (let value = 5; value < 80; ++value) {
        assert(colorOf(table, value)!.every((c, k) => Math.abs(c - colorOf(smooth, value)![k]!) < 4));
        assert.equal(extinctionPerM(table, value, 1), extinctionPerM(smooth, value, 1));
    }
    assert.deepEqual(
        cornersToKeep(5, 0.5, (first, last, i) => (first === 0 && last === 4 && i === 2 ? 1 : 0)),
        [0, 2, 4],
    );
});

test('the points of an unusual opacity are right within a few percent', () => {
    const own = draftOf(
        { ...smooth, extinction: smooth.extinction.map((point) => ({ ...point, per_km: 2 * point.per_km })) },
        'REF',
        usual,
    );
    assert(own.opacity !== null && own.opacity.length < 40);
    for (let value = 5; value < 80; value += 0.5) {
        const wanted = 2000 * extinctionPerM(smooth, value, 1);
        assert(Math.abs(perKmAt(own.opacity, value) - wanted) <= 0.07 * Math.max(wanted, 0.003), `${value}`);
    }
});

test('the drawn table equals the table of its file', () => {
    for (const one of [draft, opaque, { ...opaque, isStepped: true }, edged]) {
        for (const least of [null, 22.5]) {
            const read = tableOfFile(readToml(writeToml(fileOf(one, least)), 'a.toml'), usual);
            const drawn = tableOf(one, usual, least);
            assert.deepEqual(read.stops, drawn.stops);
            assert.deepEqual(read.extinction, drawn.extinction);
            assert.equal(read.end, drawn.end);
        }
    }
    const table = tableOf(opaque, usual);
    assert(Math.abs(extinctionPerM(table, 25, 1) - 0.001) < 1e-7, 'half way from 0 to 2 per km');
    assert.equal(extinctionPerM(table, 7, 1), 0);
    assert.equal(extinctionPerM(table, 90, 1), 0.002);
});

test('values below the threshold are not in the file', () => {
    const cut = tableOf(draft, usual, 20);
    assert.equal(colorOf(cut, 19.9), null);
    assert.deepEqual(colorOf(cut, 20), colorOf(tableOf(draft, usual), 20)!.map(Math.round));
    assert.deepEqual(colorOf(cut, 50), colorOf(tableOf(draft, usual), 50));
    assert.equal(fileOf(draft, 300).points.length, 2, 'the file of a table without visible values is valid');
});

test('an address keeps the edges of a draft', () => {
    const table = tableOf(edged, usual);
    assert.deepEqual(colorOf(table, 30), [0, 0, 200, 255]);
    assert(colorOf(table, 29.99)!.every((c, k) => Math.abs(c - [100, 100, 100, 255][k]!) < 1));
    assert.deepEqual(draftOfText(textOfDraft(edged)), edged);
    assert.deepEqual(
        withColorMoved(edged, 1, 40).colors.map((point) => point.value),
        [5, 40, 40, 60],
    );
});

test('a .pal file has opacity as alpha, and isWhole is false if that is not possible', () => {
    const thin: Draft = {
        ...draft,
        opacity: [
            { value: 5, perKm: 0.0005 },
            { value: 80, perKm: 0.0005 },
        ],
    };
    const { table, isWhole } = tableForPal(thin, usual, null);
    assert(isWhole);
    const back = readPal(writePal(table), 'a.pal', usual);
    for (const value of [5, 35, 65])
        assert(
            Math.abs(extinctionPerM(back, value, 1) * 1000 - 0.0005) < 0.002 * 1.1 ** (value - 5) * 0.005 + 1e-6,
            `${value}`,
        );
    assert.equal(tableForPal(opaque, usual, null).isWhole, false);
});

test('an address holds a draft, and nonsense is not read as a draft', () => {
    for (const one of [draft, opaque, { ...draft, isStepped: true }])
        assert.deepEqual(draftOfText(textOfDraft(one)), one);
    const text = textOfDraft(opaque);
    assert(text.length < 200 && encodeURIComponent(text) === text, text);
    for (const bad of [
        '',
        'REF',
        text.replace('REF', 'RAIN'),
        text.replace('blend', 'both'),
        text.replace('35~', '1~'),
        text.replace('35~', 'x~'),
        text.replace('40~2', '40~-2'),
        text.replace('40~2', '40~'),
        text.replace('!80!', '!NaN!'),
        text.replace('000000ff', '').replace('5~000000', '5~00'),
        `${text}!`,
        text.repeat(100),
        text.replace('5~', `${Array.from({ length: 200 }, (_, i) => `${i / 100}~000000`).join('_')}_5~`),
    ])
        assert.equal(draftOfText(bad), null, bad.slice(0, 80));
    assert.equal(draftOfText(text.replace('REF', 'constructor')), null);
});

test('points move between their neighbors, are added where there is room, and are removed down to two', () => {
    assert.deepEqual(
        withColorMoved(draft, 1, 90).colors.map((point) => point.value),
        [5, 64.85, 65],
    );
    assert.deepEqual(withColorMoved(draft, 0, -20).colors[0]!.value, -20);
    const [added, at] = withColorAdded(draft, 20);
    assert.equal(at, 1);
    assert.deepEqual(
        added.colors[1]!.color,
        colorOf(tableOf(draft, usual), 20)!.map(Math.round),
        'a new point changes nothing',
    );
    assert.equal(withColorAdded(draft, 35.01)[1], -1);
    assert.deepEqual(withColorRemoved(added, 1).colors, draft.colors);
    assert.equal(withColorRemoved(withColorRemoved(draft, 1), 0).colors.length, 2);
    assert.deepEqual(withColor(draft, 1, [1, 2, 3]).colors[1]!.color, [1, 2, 3, 255]);
    const { opacity } = opaque;
    assert.deepEqual(withOpacityMoved(opaque, opacity!, 1, 5, -1).opacity![1], { value: 10.15, perKm: 0 });
    assert.deepEqual(withOpacityAdded(opaque, opacity!, 25)[0].opacity![1], { value: 25, perKm: 1 });
    assert.deepEqual(withOpacityRemoved(opaque, opacity!, 0).opacity, [{ value: 40, perKm: 2 }]);
    assert.equal(withOpacityRemoved({ ...opaque, opacity: [opacity![0]!] }, [opacity![0]!], 0).opacity!.length, 1);
});

test('a drag is one step of undo, and an undone step can be redone', () => {
    const history = new History<number>();
    assert.equal(history.undo(7), 7);
    for (const before of [1, 2, 3]) history.note(before, 'a drag');
    history.rest();
    history.note(4, 'a drag');
    assert.equal(history.undo(5), 4);
    assert.equal(history.undo(4), 1);
    assert(!history.canUndo && history.canRedo);
    assert.equal(history.redo(1), 4);
    history.note(4);
    assert(!history.canRedo, 'another change leaves nothing to redo');
});
