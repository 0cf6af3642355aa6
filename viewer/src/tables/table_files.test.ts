import assert from 'node:assert/strict';
import test from 'node:test';

import { colorOf, extinctionPerM } from './color_table';
import { ColorTable } from '../wire/color_tables';
import { readPal, writePal } from './pal_file';
import { TableError, tableOfFile } from './table_file';
import { readToml } from './toml_file';
import { writeToml } from './toml_writer';
import { smooth, usual } from '../testing/made_tables';

const pal = (text: string): ColorTable => readPal(text, 't.pal', usual);
const toml = (text: string): ColorTable => tableOfFile(readToml(text, 't.toml'), usual);
function message(read: (text: string) => unknown, text: string): string {
    try {
        read(text);
        return '';
    } catch (error) {
        assert(error instanceof TableError, `${String(error)} for ${text}`);
        return error.message;
    }
}

const blended = `; a table of reflectivity
Product: BR
Units:   DBZ
Step:    10
Color:      5   0   0 100   100 200  50   ; to its own second color
COLOR:     15  10  20  30                 ; to the next entry's color
solidcolor: 25 200 100   0
Color4:    45  40  60  80 255
Color:     65 255 255 255   1 2 3         ; the last: nothing to blend to
RF: 119 0 125
ND: 0 0 0
`;

test('a .pal file blends as its format says', () => {
    const table = pal(blended);
    assert.equal(table.moment, 'REF');
    assert.equal(table.unit, 'dBZ');
    assert.equal(colorOf(table, 4.9), null);
    assert.deepEqual(colorOf(table, 10), [50, 100, 75, 255], 'half way to the second entry');
    assert.deepEqual(colorOf(table, 20), [105, 60, 15, 255], 'half way to the next entry');
    assert.deepEqual(colorOf(table, 44.9), [200, 100, 0, 255], 'solid');
    assert.deepEqual(colorOf(table, 90), [255, 255, 255, 255]);
    assert.equal(table.end, 75);
    assert.equal(extinctionPerM(table, 40, 1), extinctionPerM(smooth, 40, 1));
});

test('a .pal file may have falling values, edges, other units and alpha', () => {
    const rising = pal('Color: 0 1 2 3\nColor: 10 4 5 6\nSolidColor: 20 7 8 9\n');
    assert.deepEqual(pal('SolidColor: 20 7 8 9\nColor: 10 4 5 6\nColor: 0 1 2 3\n').stops, rising.stops);
    const edge = pal('Color: 0 0 0 0\nColor: 10 100 100 100\nColor: 10 0 0 200\nColor: 20 0 0 0\n');
    assert.deepEqual(colorOf(edge, 5), [50, 50, 50, 255]);
    assert.deepEqual(colorOf(edge, 10), [0, 0, 200, 255]);
    const scaled = pal(
        'Product: BV\nUnits: KTS\nScale: 2\nOffset: 1\nSolidColor: -39 0 255 0\nSolidColor: 41 255 0 0\n',
    );
    assert.equal(scaled.moment, 'VEL');
    assert.deepEqual(
        scaled.stops.map((stop) => stop.from),
        [-20, 20],
    );
    const knots = pal('Units: KT\nColor: 0 0 0 0\nColor: 100 255 0 0\n');
    assert.equal(knots.moment, 'VEL');
    assert(Math.abs(knots.stops[1]!.from - 51.4444) < 1e-4, '1 kt = 1852 m / 3600 s');
    const faded = pal('Product: BR\nSolidColor4: 5 9 9 9 0\nSolidColor4: 20 9 9 9 51\nSolidColor: 40 9 9 9\n');
    assert.equal(extinctionPerM(faded, 10, 1), 0);
    assert(Math.abs(extinctionPerM(faded, 30, 1) / extinctionPerM(smooth, 30, 1) - 0.2) < 1e-12);
});

test('errors in a .pal file name the line', () => {
    for (const [text, wanted] of [
        ['', 't.pal:1: the file has no Color:'],
        ['Color: 1 2 3 4\nbogus\n', "t.pal:2: 'bogus'"],
        ['Colr: 1 2 3 4\n', "t.pal:1: unknown key 'COLR'"],
        ['\n\nColor: 1 2 3\n', 't.pal:3: there must be a value and 3 or 6'],
        ['Color: 1 2 3 256\n', "t.pal:1: '256' is not a color"],
        ['Color: nan 2 3 4\n', "t.pal:1: 'nan'"],
        ['Color: 1e9 2 3 4\n', "t.pal:1: '1e9'"],
        ['Scale: 0\n', 't.pal:1: the number must be above 0'],
        ['RF: 1\n', 't.pal:1: there must be red'],
        [
            Array.from({ length: 5000 }, (_, i) => `Color: ${i} 0 0 0`).join('\n'),
            't.pal:4097: there are more than 4096',
        ],
        ['Color: 1 2 3 4\n\x1b[31mX: 1\n', "t.pal:2: unknown key '?[31MX'"],
    ] as const)
        assert(message(pal, text).startsWith(wanted), `${message(pal, text)} for ${text.slice(0, 40)}`);
});

const colors = `
name = "mine" # a comment
moment = "VEL"
[[point]]
value = -30
colour = "#0000ff"
opacity_per_km = 0.2
[[point]]
value = 0.0
color = [100, 100,
  100, 51]
opacity_per_km = 0
[[point]]
value = +3.0e1
'color' = "#ff000080"
opacity_per_km = 0.4
`;

test('a TOML file blends from point to point', () => {
    const table = toml(colors);
    assert.equal(table.name, 'mine');
    assert.equal(table.moment, 'VEL');
    assert.equal(table.unit, 'm/s');
    assert.deepEqual(colorOf(table, -15), [50, 50, 177.5, 153]);
    assert.deepEqual(colorOf(table, 99), [255, 0, 0, 128]);
    assert.equal(table.end, 60);
    assert(Math.abs(extinctionPerM(table, 15, 1) * 1000 - 0.2) < 1e-12);
    assert.deepEqual(toml('point = [{value = 1, color = "#000000"}, {value = 2, color = "#ffffff"}]').stops.length, 2);
});

test('a point in a TOML file may blend to a color of its own, as in a .pal file', () => {
    const table = toml(
        'moment = "REF"\n[[point]]\nvalue = 10\ncolor = "#000000"\nuntil = "#646464"\n[[point]]\nvalue = 20\ncolor = "#0000c8"\nuntil = "#0000c8"\n' +
            '[[point]]\nvalue = 30\ncolor = "#c80000"\n[[point]]\nvalue = 40\ncolor = "#ffffff"\n',
    );
    const same = pal(
        'Product: BR\nColor: 10 0 0 0 100 100 100\nSolidColor: 20 0 0 200\nColor: 30 200 0 0\nColor: 40 255 255 255\n',
    );
    assert.deepEqual(table.stops, same.stops);
    assert.deepEqual(table.extinction, same.extinction);
});

const two = '[[point]]\nvalue = 1\ncolor = "#000000"\n[[point]]\nvalue = 2\ncolor = "#ffffff"\n';

test('errors in a TOML file name the line', () => {
    assert.equal(message(toml, two), '');
    for (const [text, wanted] of [
        [`moment = "RAIN"\n${two}`, 't.toml:1: moment must be'],
        [`unit = "kt"\nmoment = "VEL"\n${two}`, 't.toml:1: unit of VEL'],
        [`stepped = 1\n${two}`, 't.toml:1: stepped must be true or false'],
        [`color = 1\n${two}`, 't.toml:1: color is an unknown key'],
        [`${two}opacity_per_km = 1\n`, 't.toml:1: opacity_per_km must be given'],
        [`${two}[[point]]\nvalue = 2\ncolor = "#000000"\n`, 't.toml:8: value must increase'],
        [`${two}[[point]]\nvalue = 3\ncolor = "#00000"\n`, 't.toml:9: color must be'],
        [`${two}[[point]]\nvalue = 3\ncolor = [1, 2, 256]\n`, 't.toml:9: color must be'],
        [`${two}[[point]]\nvalue = nan\ncolor = "#000000"\n`, 't.toml:8: value is out of range'],
        [`stepped = true\n${two}until = "#000000"\n`, 't.toml:8: until has no meaning'],
        [`${two}[[point]]\ncolor = "#000000"\n`, 't.toml:7: value is missing'],
        [`end = 2\n${two}`, 't.toml:1: end must be above'],
        ['[[point]]\nvalue = 1\ncolor = "#000000"\n', 't.toml:1: point must be there 2 to 4096'],
        ['point = 7\n', 't.toml:1: point must be'],
        ['name = "x', `t.toml:1: unfinished string, in 'name = "x'`],
        ['name = "x\n', `t.toml:1: control characters are not allowed in strings, in 'name = "x'`],
        ['name = x\n', "t.toml:1: invalid value, in 'name = x'"],
        ['name = 1979-05-27\n', 't.toml:1: name must be a text'],
        ['a = 1\na = 2\n', "t.toml:2: trying to redefine an already defined table or value, in 'a = 2'"],
        ['a = "\\q"\n', 't.toml:1: unrecognised escape sequence'],
        ['[[point]\n', "t.toml:1: expected end of table array declaration, in '[[point]'"],
        [`a = ${'['.repeat(100000)}`, 't.toml:1: the values are too deep'],
        ['<html>', "t.toml:1: illegal character in key, in '<html>'"],
    ] as const)
        assert(message(toml, text).startsWith(wanted), `${message(toml, text)} for ${text.slice(0, 60)}`);
});

test('lines are found after texts of several lines, and in arrays of inline tables', () => {
    for (const [text, wanted] of [
        [`name = """a \\"""\n[b]"""\nq = 1\n${two}`, 't.toml:3: q is an unknown key'],
        [`"#" = [ # ]\n'''\n]''',\n]\n${two}`, 't.toml:1: # is an unknown key'],
        [`a.b = 1\n[a.c]\nd = 1\n${two}`, 't.toml:1: a is an unknown key'],
        [`end = 3\n${two}\n[point.x]\n`, 't.toml:9: x is an unknown key'],
        [
            'point = [\n  { value = 1, color = "#000000" },\n  { value = 2,\n    colr = 3 },\n]',
            't.toml:3: color is missing',
        ],
        ['point = [{ value = 1, color = [1,\n2, 3] },\n{ value = 0, color = "#000000" }]', 't.toml:3: value must incr'],
    ] as const)
        assert(message(toml, text).startsWith(wanted), `${message(toml, text)} for ${text}`);
});

test('a key named like a property of JavaScript objects is unknown like any other', () => {
    assert.equal(message(toml, `constructor = 1\n${two}`), 't.toml:1: constructor is an unknown key');
    assert.equal(message(toml, `__proto__ = 1\n${two}`), 't.toml:1: __proto__ is an unknown key');
    assert(message(toml, `moment = "constructor"\n${two}`).includes('must be one of'));
    assert.equal(pal('Product: constructor\nUnits: __proto__\nColor: 1 2 3 4\n').moment, '');
});

test('a written file is read as the same table', () => {
    const file = readToml(colors, 't.toml');
    assert.deepEqual(readToml(writeToml(file), 't.toml'), file);
    const named = { ...file, name: 'a "b\\c"' };
    assert.equal(readToml(writeToml(named), 't.toml').name, named.name);
    const table = { ...pal(blended), name: 'mine' };
    const again = pal(writePal(table));
    assert.deepEqual(again.stops.slice(0, -1), table.stops.slice(0, -1));
    assert.deepEqual(colorOf(again, 70), colorOf(table, 70));
    assert.equal(again.end, table.end);
    assert.deepEqual(again.range_folded, table.range_folded);
});

test('a damaged file gives an error of one line, or a table whose numbers make sense', () => {
    let seed = 20261127;
    const random = (below: number) => ((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) >>> 8) % below;
    const spice = '0123456789-+.e:;#\n" []=,nanCSolidcolor4{}\'\0\x80é';
    for (const [text, read] of [
        [blended, pal],
        [colors, toml],
    ] as const) {
        let accepted = 0;
        for (let round = 0; round < 3000; ++round) {
            let changed: string = text;
            for (let change = random(4); change < 4; ++change) {
                const at = random(changed.length + 1);
                const put =
                    random(3) === 0
                        ? changed.slice(random(changed.length + 1)).slice(0, random(30))
                        : spice[random(spice.length)]!;
                changed = changed.slice(0, at) + put + changed.slice(at + random(4));
            }
            try {
                const table = read(changed);
                ++accepted;
                assert(
                    table.stops.every(
                        (stop, i) => Number.isFinite(stop.from) && (i === 0 || stop.from > table.stops[i - 1]!.from),
                    ),
                    changed,
                );
                for (let value = -80; value < 120; value += 7.3) assert(extinctionPerM(table, value, 1) >= 0, changed);
            } catch (error) {
                assert(
                    error instanceof TableError && !error.message.includes('\n') && error.message.startsWith('t.'),
                    `${String(error)} for ${changed}`,
                );
            }
        }
        assert(accepted > 20, 'changes that always fail test little');
    }
});
