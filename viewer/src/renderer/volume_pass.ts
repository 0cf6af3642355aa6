// Draws the volume by rays, with the transfer function of its table.

import { cellSizeM } from '../earth/projection';
import { Transfer, makeTransfer } from '../tables/transfer';
import { ColorTable } from '../wire/color_tables';
import { PackedGrid } from '../wire/packed_grid';
import { RayView, TilePass, blockEnds, tilesOf } from './echo_tiles';
import { Exposure } from './exposure';
import { Frame } from './frame';
import { Graphics } from './graphics';
import { GridTextures } from './grid_textures';
import { bindGrid, levelSpacingM, slicedDepths } from './grid_uniforms';
import { LayerPasses } from './layer_passes';
import { Parts } from './picture';
import { VolumeVariant, volumeProgram } from './shader_programs';

// Inputs of a transfer function except the step: table, first value and step of codes, opacity, and least value.
type TransferKey = readonly [ColorTable, number, number, number, number];
type WantedOfVolume = Pick<VolumeVariant, 'countsFetches' | 'endsAtSolids' | 'isLit' | 'measuresLight'>;

// A transfer function is for steps of one length. If the length changes by at most this factor, the optical depths are
// scaled; otherwise the transfer function is made again.
const mostStretch = 1.25;

export class VolumePass {
    private gl: WebGL2RenderingContext;
    private exposure: Exposure;
    private tiles: TilePass;
    private transferTexture: WebGLTexture | null = null;
    private transfer: { made: Transfer; stepM: number; key: TransferKey } | null = null;

    constructor(
        private graphics: Graphics,
        private grids: GridTextures,
        private passes: LayerPasses,
    ) {
        this.gl = graphics.gl;
        this.tiles = new TilePass(graphics.gl);
        this.exposure = new Exposure(graphics.gl);
    }

    // Begins to compile the program of the first picture.
    prepare(): void {
        this.graphics.begin(volumeProgram({ isPerspective: true, hasUnevenLevels: false }));
    }

    // Releases what the pass keeps for the next picture.
    release(): void {
        this.gl.deleteTexture(this.transferTexture);
        this.exposure.release();
        this.forget();
    }

    // Call after the context came back.
    forget(): void {
        this.tiles.forget();
        this.exposure.forget();
        this.transferTexture = null;
        this.transfer = null;
    }

    // Draws the volume. `view` is the camera of the picture, or of a smaller picture of the same view.
    draw(frame: Frame, wanted: WantedOfVolume, view: RayView = frame.geometry): void {
        const { geometry, layers } = frame;
        const { loaded } = frame;
        if (loaded.atlas.brickCount === 0) return;
        const uploaded = this.grids.uploadedOf(loaded);
        const { levels } = uploaded;
        const { grid } = loaded;
        const variant: VolumeVariant = {
            isPerspective: geometry.isPerspective,
            hasUnevenLevels: levels !== null,
            hasHalved: loaded.stream !== null,
            ...wanted,
        };
        const program = this.graphics.use(volumeProgram(variant), view);
        const [nearM, farM] = slicedDepths(loaded, geometry);
        const { made, scale } = this.transferFor(frame, grid, (farM - nearM) / frame.slices);
        if (made.leastVisibleCode === Infinity) return;
        bindGrid(this.gl, uploaded, frame, program);
        program.texture2d('transfer', 2, this.transferTexture);
        const { codeScale, codeOffset } = loaded.atlas;
        program.vec2('binLine', made.binOffset + made.binSlope * codeOffset, made.binSlope * codeScale);
        const leastShown = Math.min(255, Math.max(1, Math.floor((made.leastVisibleCode - codeOffset) / codeScale)));
        program.uint('leastShown', leastShown);
        program.float('depthScale', scale);
        if (variant.endsAtSolids) this.passes.bindSolidDepth(4, program, geometry);
        if (variant.isLit && layers?.falls) {
            this.passes.bindLight(5, layers.falls, geometry, cellSizeM(grid), levelSpacingM(grid), program);
            program.float('exposure', this.exposure.value);
        }
        this.tiles.draw(view, tilesOf(view, loaded.atlas, blockEnds(grid, geometry), leastShown), program);
    }

    // Measures the exposure of the lit echo in a small picture.
    *measureLight(frame: Frame): Parts {
        const { gl } = this;
        this.exposure.begin(frame.geometry, (small) => {
            gl.disable(gl.BLEND);
            this.draw(frame, { isLit: true, measuresLight: true }, small);
        });
        this.graphics.drawToPicture();
        yield;
        this.exposure.end();
    }

    // Returns the transfer function for a step, and the factor for its optical depths.
    private transferFor(frame: Frame, grid: PackedGrid, stepM: number): { made: Transfer; scale: number } {
        const gl = this.gl;
        const now = this.transfer;
        const key: TransferKey = [frame.table, grid.firstValue, grid.step, frame.opacity, frame.leastValue];
        const stretch = now?.key.every((part, i) => part === key[i]) ? stepM / now.stepM : 0;
        if (!now || stretch > mostStretch || stretch < 1 / mostStretch) {
            const made = makeTransfer(frame.table, grid, { opacity: frame.opacity, least: frame.leastValue }, stepM);
            this.transfer = { made, stepM, key };
            gl.deleteTexture(this.transferTexture);
            this.transferTexture = this.graphics.texture2d(gl.RGBA32F, gl.RGBA, gl.FLOAT, 256, 256, made.entries);
            return { made, scale: 1 };
        }
        return { made: now.made, scale: stretch };
    }
}
