// Cuts flat fields from the exact codes of a grid: a plane at one height, and the maxima of columns. They agree with
// the products `cappi` and `composite` of pictures.
//
// A field has a state and a value for each of its places, x fastest, y from the south on. The value is 0 unless the
// state is a value.

import { heightRange } from '../camera/geometry';
import { PackedGrid, stateOf, valueOf } from '../wire/packed_grid';
import { levelCodes } from './level_codes';
import { Mixer, mixingOf } from './status_rule';

export interface FlatField {
    width: number;
    height: number;
    states: Uint8Array;
    values: Float32Array;
}

export function emptyField(width: number, height: number): FlatField {
    return { width, height, states: new Uint8Array(width * height), values: new Float32Array(width * height) };
}

export interface LevelPair {
    lower: number;
    upper: number;
    upperShare: number;
}

// Returns the levels below and above a height; null if the grid has no cells there. The cells of the lowest and highest
// levels reach half a step beyond these levels.
export function levelsAbout(levelsM: ArrayLike<number>, heightM: number): LevelPair | null {
    const { bottomM, topM } = heightRange(levelsM);
    if (!(heightM >= bottomM && heightM <= topM)) return null;
    let upper = 0;
    while (upper < levelsM.length && levelsM[upper]! < heightM) ++upper;
    if (upper === levelsM.length) return { lower: upper - 1, upper: upper - 1, upperShare: 0 };
    if (upper === 0 || levelsM[upper] === heightM) return { lower: upper, upper, upperShare: 0 };
    const below = levelsM[upper - 1]!;
    return { lower: upper - 1, upper, upperShare: (heightM - below) / (levelsM[upper]! - below) };
}

// Cuts the plane at a height above sea level; null if the grid has no cells at this height.
export function planeField(grid: PackedGrid, moment: string, heightM: number): FlatField | null {
    const levels = levelsAbout(grid.levelsM, heightM);
    if (!levels) return null;
    const field = emptyField(grid.nx, grid.ny);
    const lowers = levelCodes(grid, levels.lower);
    const uppers = levels.upperShare > 0 ? levelCodes(grid, levels.upper) : lowers;
    const mixer = new Mixer(mixingOf(moment));
    for (let at = 0; at < lowers.length; ++at) {
        const [lower, upper] = [lowers[at]!, uppers[at]!];
        if (lower === upper) {
            field.states[at] = stateOf(grid, lower);
            if (lower >= grid.firstCode) field.values[at] = valueOf(grid, lower);
            continue;
        }
        mixer.clear();
        mixer.add(stateOf(grid, lower), valueOf(grid, lower), 1 - levels.upperShare);
        mixer.add(stateOf(grid, upper), valueOf(grid, upper), levels.upperShare);
        mixer.result();
        field.states[at] = mixer.state;
        field.values[at] = mixer.value;
    }
    return field;
}

export function maximumField(grid: PackedGrid): FlatField {
    // The greatest code is also the right state: values rank above ambiguous, range folded, no echo and not seen, in
    // this order.
    const greatest = new Uint16Array(grid.nx * grid.ny);
    const codes = new Uint16Array(greatest.length);
    for (let z = 0; z < grid.nz; ++z) {
        levelCodes(grid, z, codes);
        for (let i = 0; i < codes.length; ++i) if (codes[i]! > greatest[i]!) greatest[i] = codes[i]!;
    }
    const field = emptyField(grid.nx, grid.ny);
    greatest.forEach((code, at) => {
        field.states[at] = stateOf(grid, code);
        if (code >= grid.firstCode) field.values[at] = valueOf(grid, code);
    });
    return field;
}
