// Draws surfaces around the values of a grid, and columns of rotation.

import { LoadedGrid } from '../atlas/loaded_grid';
import { cellSizeM } from '../earth/projection';
import { columnShare } from '../scene/layers';
import { Frame } from './frame';
import { Graphics } from './graphics';
import { GridTextures, UploadedGrid } from './grid_textures';
import { bindGrid, levelSpacingM, perTexel, slotStrides } from './grid_uniforms';
import { DrawnLayers, DrawnSurface, LayerPasses } from './layer_passes';
import { Program } from './program';
import { SurfaceVariant, surfaceProgram } from './shader_programs';
import { shades } from './shades';

export class SurfacePass {
    private gl: WebGL2RenderingContext;

    constructor(
        private graphics: Graphics,
        private grids: GridTextures,
        private passes: LayerPasses,
    ) {
        this.gl = graphics.gl;
    }

    // Draws the surface around the values of a layer.
    draw(frame: Frame, shown: UploadedGrid, layers: DrawnLayers, { value, isBelow, of }: DrawnSurface): void {
        const surface = of ? this.grids.uploadedOf(of) : shown;
        if (surface.loaded.atlas.brickCount === 0) return;
        const program = this.useSurface(frame, surface, value, { isBelow, hasOther: of !== null });
        if (of) {
            program.texture3d('otherAtlas', 4, shown.atlas);
            program.texture3d('otherIndirection', 5, shown.indirection);
            program.vec3('otherSlots', slotStrides(shown.loaded.atlas));
            program.vec3('otherPerTexel', perTexel(shown.loaded.atlas));
        }
        // value = firstValue + step * (code - 3), code = codeOffset + codeScale * shown code
        const colored = shown.loaded;
        const zero = colored.grid.firstValue + colored.grid.step * (colored.atlas.codeOffset - 3);
        this.passes.bindLooks(2, layers, program, [zero, colored.grid.step * colored.atlas.codeScale]);
        this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
    }
    // Returns the program of a surface around values of a grid, with all but its colors.
    private useSurface(
        frame: Frame,
        surface: UploadedGrid,
        value: number,
        how: Pick<SurfaceVariant, 'isBelow' | 'hasOther' | 'isColumn'>,
    ): Program {
        const { geometry } = frame;
        const wanted = surfaceProgram({
            isPerspective: geometry.isPerspective,
            hasUnevenLevels: surface.levels !== null,
            hasHalved: surface.loaded.stream !== null,
            ...how,
        });
        const program = this.graphics.use(wanted, geometry);
        bindGrid(this.gl, surface, frame, program);
        const { grid, atlas } = surface.loaded;
        const chosen = (3 + (value - grid.firstValue) / grid.step - atlas.codeOffset) / atlas.codeScale;
        program.float('chosen', chosen);
        program.uint('leastShown', how.isBelow ? 1 : Math.min(255, Math.max(1, Math.floor(chosen))));
        const [width, height] = cellSizeM(grid);
        program.vec3('cellM', [width, height, levelSpacingM(grid) * geometry.exaggeration]);
        program.vec2('depthRange', geometry.nearM, geometry.farM);
        this.passes.bindSun(geometry, program);
        return program;
    }

    // Draws columns of rotation over everything else, because echo would hide them. The echo shows through them.
    drawRotation(frame: Frame, of: LoadedGrid): void {
        const surface = this.grids.uploadedOf(of);
        if (surface.loaded.atlas.brickCount === 0) return;
        this.gl.enable(this.gl.BLEND);
        for (const isBelow of [false, true]) {
            const value = isBelow ? -columnShare : columnShare;
            const program = this.useSurface(frame, surface, value, { isBelow, isColumn: true });
            program.colors('columnColor', shades.turning[isBelow ? 1 : 0]!);
            this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
        }
    }
}
