import assert from 'node:assert/strict';
import test from 'node:test';

import { Program } from './program';

// Returns a fake of WebGL that has two uniforms and records calls.
function noted(): { gl: WebGL2RenderingContext; lookUps: string[]; values: unknown[][] } {
    const [lookUps, values]: [string[], unknown[][]] = [[], []];
    const names = ['scale', 'landShades[0]'];
    const gl = {
        getProgramParameter: () => names.length,
        getActiveUniform: (_: unknown, i: number) => ({ name: names[i] }),
        getUniformLocation: (_: unknown, name: string) => lookUps.push(name) && `place of ${name}`,
        uniform1f: (...words: unknown[]) => values.push(words),
        uniform3fv: (...words: unknown[]) => values.push(words),
    };
    return { gl: gl as unknown as WebGL2RenderingContext, lookUps, values };
}

test('locations of uniforms and of arrays are looked up once', () => {
    const { gl, lookUps, values } = noted();
    const program = new Program(gl, {});
    for (const value of [1, 2]) program.float('scale', value);
    program.colors('landShades', [255, 0, 51], [0, 255, 0, 128]);
    assert.deepEqual(lookUps, ['scale', 'landShades[0]']);
    assert.deepEqual(values, [
        ['place of scale', 1],
        ['place of scale', 2],
        ['place of landShades[0]', [1, 0, 0.2, 0, 1, 0]],
    ]);
});

test('setting a uniform that the variant does not have does nothing', () => {
    const { gl, values } = noted();
    new Program(gl, {}).float('exposure', 1);
    assert.deepEqual(values, [[null, 1]]);
});
