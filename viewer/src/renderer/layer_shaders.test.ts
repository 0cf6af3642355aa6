import assert from 'node:assert/strict';
import test from 'node:test';

import { exposureOf } from './exposure';
import {
    AirVariant,
    SurfaceVariant,
    airFragment,
    airName,
    drapeFragment,
    fieldFragment,
    surfaceFragment,
    surfaceName,
    sweepFragment,
} from './layer_shaders';
import { VolumeVariant, variantName, volumeFragment } from './shaders';
import { lookCount, lookOver, looksOf } from '../tables/looks';
import { ColorTable } from '../wire/color_tables';

const either = [false, true];
const plain: VolumeVariant = { isPerspective: true, hasUnevenLevels: false };

test('each variant of the volume, of a surface and of veils has a name and a program of its own', () => {
    const volumes: VolumeVariant[] = either.flatMap((isPerspective) =>
        either.flatMap((hasUnevenLevels) =>
            either.flatMap((endsAtSolids) =>
                either.map((isLit) => ({ isPerspective, hasUnevenLevels, endsAtSolids, isLit })),
            ),
        ),
    );
    const surfaces: SurfaceVariant[] = either.flatMap((isPerspective) =>
        either.flatMap((hasHalved) =>
            either.flatMap((isBelow) =>
                either.map((hasOther) => ({ isPerspective, hasUnevenLevels: false, hasHalved, isBelow, hasOther })),
            ),
        ),
    );
    const veils: AirVariant[] = either.flatMap((hasHaze) =>
        either.map((hasFolded) => ({ isPerspective: true, hasUnevenLevels: false, hasHaze, hasFolded })),
    );
    for (const [names, programs] of [
        [volumes.map(variantName), volumes.map(volumeFragment)],
        [surfaces.map(surfaceName), surfaces.map(surfaceFragment)],
        [veils.map(airName), veils.map(airFragment)],
    ] as const) {
        assert.equal(new Set(names).size, names.length);
        assert.equal(new Set(programs).size, programs.length);
    }
});

test('what is off is not in the program of the volume', () => {
    const usual = volumeFragment(plain);
    for (const word of ['solidDepth', 'litColor', 'falls', 'exposure', 'lit ', 'frontLight'])
        assert(!usual.includes(word), word);
    assert(volumeFragment({ ...plain, endsAtSolids: true }).includes('solidDepth'));
    assert(!volumeFragment({ ...plain, endsAtSolids: true }).includes('falls'));
    assert(volumeFragment({ ...plain, isLit: true }).includes('falls'));
    assert(!surfaceFragment({ ...plain, isBelow: false, hasOther: false }).includes('otherAtlas'));
});

test('programs say their version first, as WebGL 2 wants it', () => {
    const texts = [
        fieldFragment(true),
        sweepFragment(false),
        drapeFragment(true),
        surfaceFragment({ ...plain, isBelow: true, hasOther: true }),
    ];
    for (const text of texts) assert(text.startsWith('#version 300 es\n'));
});

test('the exposure keeps the mean lightness', () => {
    const pixels = (factor: number) =>
        new Uint8Array(Array.from({ length: 50 }, (_, i) => [100 + i, Math.round(127.5 * factor), 200, 255]).flat());
    assert(Math.abs(exposureOf(pixels(1)) - 1) < 0.01);
    assert(Math.abs(exposureOf(pixels(0.8)) * 0.8 - 1) < 0.01);
    assert.equal(exposureOf(new Uint8Array(80)), 1);
});

test('looks are the colors of values, clear below the table and the threshold', () => {
    const table: ColorTable = {
        name: 'two',
        moment: 'REF',
        unit: 'dBZ',
        bar_begin: 0,
        end: 20,
        range_folded: [1, 2, 3, 255],
        extinction: [],
        stops: [
            { from: 5, color: [255, 0, 0, 255], until: [255, 0, 0, 255] },
            { from: 10, color: [0, 0, 255, 51], until: [0, 0, 255, 51] },
        ],
    };
    const looks = looksOf(table, -100);
    assert.equal(looks.rgba.length, 4 * lookCount);
    assert.equal(lookOver(looks, 4.9, [0, 0, 0]), null);
    assert.deepEqual(lookOver(looks, 5, [0, 0, 0]), [255, 0, 0]);
    assert.deepEqual(lookOver(looks, 9.98, [0, 0, 0]), [255, 0, 0]);
    assert.deepEqual(lookOver(looks, 10, [0, 0, 0]), [0, 0, 51]);
    assert.deepEqual(lookOver(looks, 99, [100, 0, 0]), [80, 0, 51]);
    for (const least of [8, 8.5, 7.3]) {
        assert.equal(lookOver(looksOf(table, least), least - 0.01, [0, 0, 0]), null);
        assert.deepEqual(lookOver(looksOf(table, least), least, [0, 0, 0]), [255, 0, 0]);
    }
});
