// Gives programs the textures and the geometry of a grid.

import { Atlas } from '../atlas/atlas';
import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { cellSizeM } from '../earth/projection';
import { croppedBox } from '../scene/layers';
import { PackedGrid } from '../wire/packed_grid';
import { Frame } from './frame';
import { UploadedGrid } from './grid_textures';
import { Program } from './program';

// Gives a program the textures and the geometry of a grid, and the steps of its rays.
export function bindGrid(
    gl: WebGL2RenderingContext,
    { loaded, atlas, indirection, levels, levelRange }: UploadedGrid,
    frame: Frame,
    program: Program,
): void {
    const { grid } = loaded;
    const { box, exaggeration } = frame.geometry;
    const [nearM, farM] = slicedDepths(loaded, frame.geometry);
    const [cellWidth, cellHeight] = cellSizeM(grid);
    program.texture3d('atlas', 0, atlas);
    const filter = frame.isNearest ? gl.NEAREST : gl.LINEAR;
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_3D, name, filter);
    program.texture3d('indirection', 1, indirection);
    if (levels) {
        program.texture2d('levels', 3, levels);
        program.vec2('levelRange', levelRange[0] * exaggeration, levelRange[1] * exaggeration);
    } else {
        const spacing = grid.nz > 1 ? grid.levelsM[1]! - grid.levelsM[0]! : 1;
        program.vec2('levelLine', -grid.levelsM[0]! / spacing, 1 / (spacing * exaggeration));
    }
    const whole = {
        westM: -box.halfXM,
        eastM: box.halfXM,
        southM: -box.halfYM,
        northM: box.halfYM,
        bottomM: box.bottomM,
        topM: box.topM,
    };
    const inside = croppedBox(whole, frame.layers?.crop ?? null);
    program.vec3('boxLow', [inside.westM, inside.southM, inside.bottomM * exaggeration]);
    program.vec3('boxHigh', [inside.eastM, inside.northM, inside.topM * exaggeration]);
    program.floats('brickHeights', brickHeights(grid, frame.geometry));
    program.vec3('cells', [grid.nx, grid.ny, grid.nz]);
    program.vec2('perCell', 1 / cellWidth, 1 / cellHeight);
    program.vec3('slots', slotStrides(loaded.atlas));
    program.vec3('perTexel', perTexel(loaded.atlas));
    program.float('near', nearM);
    program.float('stepM', (farM - nearM) / frame.slices);
    program.float('slices', frame.slices);
}

// Returns the depths of the first and the last slice. For a grid in parts, slices are only in its visible part, which
// may be a small part of the box.
export function slicedDepths(loaded: LoadedGrid, geometry: ViewGeometry): [number, number] {
    return loaded.stream ? geometry.shownDepths : [geometry.nearM, geometry.farM];
}

// Returns the mean distance between levels, at least 1 m.
export function levelSpacingM({ levelsM }: PackedGrid): number {
    const last = levelsM.length - 1;
    return Math.max(1, (levelsM[last]! - levelsM[0]!) / Math.max(1, last));
}

export function slotStrides({ slots }: Atlas): [number, number, number] {
    return [slots[0], slots[1], slots[0] * slots[1]];
}
export function perTexel({ size }: Atlas): [number, number, number] {
    return [1 / size[0], 1 / size[1], 1 / size[2]];
}

// Returns the drawn heights at which layers of bricks begin, and at which the last layer ends. A sample belongs to the
// layer of the level below it.
function brickHeights(grid: PackedGrid, { box, exaggeration }: ViewGeometry): Float32Array {
    const heights = new Float32Array(66);
    for (let layer = 0; layer < heights.length; ++layer) {
        const level = layer * grid.brickEdge;
        const height = layer === 0 ? box.bottomM - 1 : level < grid.nz ? grid.levelsM[level]! : box.topM + 1;
        heights[layer] = height * exaggeration;
    }
    return heights;
}
