// Flat cuts of a grid, from its exact codes: a plane at one height and the maxima of columns, as the
// products `cappi` and `composite` of the pictures have them.
//
// A field has a state and a value for each of its places, x fastest, y from the south on. Its values are
// 0 where the state is none.

import { heightRange } from '../camera/geometry';
import { BrickKind, CellState, PackedGrid, codeAt, firstValueCode, valueOf } from '../wire/packed_grid';
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

export const stateOfCode = (code: number): CellState => (code >= firstValueCode ? CellState.value : (code as CellState));

export interface LevelPair {
    lower: number;
    upper: number;
    upperShare: number;
}

// The levels about a height; the cells of the outermost reach half a level beyond them. Null where the
// grid has no cells.
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

// The plane at a height above sea level; null where the grid has no cells.
export function planeField(grid: PackedGrid, moment: string, heightM: number): FlatField | null {
    const levels = levelsAbout(grid.levelsM, heightM);
    if (!levels) return null;
    const field = emptyField(grid.nx, grid.ny);
    const mixer = new Mixer(mixingOf(moment));
    for (let y = 0, at = 0; y < grid.ny; ++y) {
        for (let x = 0; x < grid.nx; ++x, ++at) {
            const lower = codeAt(grid, x, y, levels.lower);
            const upper = levels.upperShare > 0 ? codeAt(grid, x, y, levels.upper) : lower;
            if (lower === upper) {
                field.states[at] = stateOfCode(lower);
                if (lower >= firstValueCode) field.values[at] = valueOf(grid, lower);
                continue;
            }
            mixer.clear();
            mixer.add(stateOfCode(lower), valueOf(grid, lower), 1 - levels.upperShare);
            mixer.add(stateOfCode(upper), valueOf(grid, upper), levels.upperShare);
            mixer.result();
            field.states[at] = mixer.state;
            field.values[at] = mixer.value;
        }
    }
    return field;
}

// Raises the greatest codes of columns by the cells of one brick. States rank as the product has it: a
// value before range folded, that before no echo, that before not seen.
function raiseByBrick(grid: PackedGrid, bx: number, by: number, bz: number, greatest: Uint16Array): void {
    const edge = grid.brickEdge;
    const brick = (bx * grid.bricks[1] + by) * grid.bricks[2] + bz;
    const kind = grid.kind[brick];
    const depth = Math.min(edge, grid.nz - bz * edge);
    for (let x = bx * edge; x < Math.min(grid.nx, (bx + 1) * edge); ++x) {
        for (let y = by * edge; y < Math.min(grid.ny, (by + 1) * edge); ++y) {
            const column = y * grid.nx + x;
            if (kind === BrickKind.uniform) {
                greatest[column] = Math.max(greatest[column]!, grid.state[brick]!);
                continue;
            }
            let most = greatest[column]!;
            if (kind === BrickKind.codes) {
                const from = grid.block[brick]! * edge ** 3 + ((x - bx * edge) * edge + (y - by * edge)) * edge;
                for (let z = 0; z < depth; ++z) most = Math.max(most, grid.codes[from + z]!);
            } else {
                for (let z = 0; z < depth; ++z) most = Math.max(most, codeAt(grid, x, y, bz * edge + z));
            }
            greatest[column] = most;
        }
    }
}

// The greatest value of each column.
export function maximumField(grid: PackedGrid): FlatField {
    const greatest = new Uint16Array(grid.nx * grid.ny);
    for (let x = 0; x < grid.bricks[0]; ++x) {
        for (let y = 0; y < grid.bricks[1]; ++y) {
            for (let z = 0; z < grid.bricks[2]; ++z) raiseByBrick(grid, x, y, z, greatest);
        }
    }
    const field = emptyField(grid.nx, grid.ny);
    greatest.forEach((code, at) => {
        field.states[at] = stateOfCode(code);
        if (code >= firstValueCode) field.values[at] = valueOf(grid, code);
    });
    return field;
}
