import assert from 'node:assert/strict';
import test from 'node:test';

import { groundFragment, variantName, volumeFragment } from './shaders';

test('each variant of the volume has a name and a program of its own', () => {
    const variants = [false, true].flatMap((isPerspective) =>
        [false, true].map((hasUnevenLevels) => ({ isPerspective, hasUnevenLevels })),
    );
    assert.equal(new Set(variants.map(variantName)).size, 4);
    assert.equal(new Set(variants.map(volumeFragment)).size, 4);
});

test('what a scene does not call for is not in its program', () => {
    assert(!volumeFragment({ isPerspective: true, hasUnevenLevels: false }).includes('levelRange'));
    assert(volumeFragment({ isPerspective: true, hasUnevenLevels: true }).includes('levelRange'));
});

test('programs say their version first, as WebGL 2 wants it', () => {
    for (const text of [volumeFragment({ isPerspective: true, hasUnevenLevels: true }), groundFragment(false)])
        assert(text.startsWith('#version 300 es\n'));
});
