// Draws ground, map lines, layers and volume with WebGL2.

import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { MapLines } from '../scene/ground_lines';
import { Frame } from './frame';
import { Graphics } from './graphics';
import { GridTextures, UploadedGrid } from './grid_textures';
import { bindGrid } from './grid_uniforms';
import { DrawnLayers, LayerPasses, hasSolids } from './layer_passes';
import { LinePass } from './line_pass';
import { airProgram, groundProgram } from './shader_programs';
import { shades } from './shades';
import { SurfacePass } from './surface_pass';
import { VolumePass } from './volume_pass';
import { WaterMask, WaterTexture } from './water_texture';

export class Renderer {
    private gl: WebGL2RenderingContext;
    private graphics: Graphics;
    private grids: GridTextures;
    private passes: LayerPasses;
    private volume: VolumePass;
    private surfaces: SurfacePass;
    private lines: LinePass;
    private water: WaterTexture;

    constructor(readonly canvas: HTMLCanvasElement) {
        const gl = canvas.getContext('webgl2', { antialias: false, preserveDrawingBuffer: true, alpha: false });
        if (!gl) throw new Error('webgl2');
        this.gl = gl;
        this.graphics = new Graphics(gl);
        this.grids = new GridTextures(this.graphics);
        this.passes = new LayerPasses(this.graphics);
        this.volume = new VolumePass(this.graphics, this.grids, this.passes);
        this.surfaces = new SurfacePass(this.graphics, this.grids, this.passes);
        this.lines = new LinePass(this.graphics);
        this.water = new WaterTexture(this.graphics);
        canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    }

    get mostTexels(): number {
        return this.graphics.mostTexels;
    }
    get isSoftware(): boolean {
        return this.graphics.isSoftware;
    }
    // Returns true while the WebGL context is lost, so that nothing can be drawn.
    get isLost(): boolean {
        return this.gl.isContextLost();
    }
    get compiledVariants(): string[] {
        return this.graphics.compiledVariants;
    }

    // Call after the context came back. The owners of the data then upload them again.
    forget(): void {
        this.graphics.forget();
        this.lines.forget();
        this.water.forget();
        this.grids.forget();
        this.passes.forget();
        this.volume.forget();
    }

    show(loaded: LoadedGrid): void {
        this.grids.show(loaded);
    }
    // Copies bricks into the atlas. `texels` has the bricks of the slots that are not -1, in their order.
    putBricks(slots: Int32Array, texels: Uint8Array): void {
        this.grids.putBricks(slots, texels);
    }
    // Uploads the atlas's indirection. Call after a change of the indirection.
    putIndirection(): void {
        this.grids.putIndirection();
    }

    draw(frame: Frame): void {
        const gl = this.gl;
        const { geometry } = frame;
        if (this.canvas.width !== geometry.width || this.canvas.height !== geometry.height) {
            this.canvas.width = geometry.width;
            this.canvas.height = geometry.height;
        }
        const layers = frame.layers ?? null;
        const uploaded = this.grids.shown;
        const isSolid = layers !== null && uploaded !== null && hasSolids(layers);
        this.passes.begin(isSolid);
        this.grids.keepOthers([layers?.surface?.of, layers?.rotation]);
        if (isSolid)
            this.passes.drawSolids(geometry, layers, (surface) => this.surfaces.draw(frame, uploaded, layers, surface));
        gl.viewport(0, 0, geometry.width, geometry.height);
        gl.disable(gl.BLEND);
        gl.clearColor(
            frame.hasGround ? shades.page[0] / 255 : 0,
            frame.hasGround ? shades.page[1] / 255 : 0,
            frame.hasGround ? shades.page[2] / 255 : 0,
            1,
        );
        gl.clear(gl.COLOR_BUFFER_BIT);
        if (!uploaded) return;
        if (frame.hasGround) {
            this.drawGround(uploaded, geometry, frame.grain, layers?.hasHaze ?? false);
        }
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        if (layers?.maximum) this.passes.drawMaximum(geometry, layers, layers.maximum);
        if (frame.hasGround) this.lines.draw(geometry, frame.grain);
        if (layers?.air && (layers.hasHaze || layers.hasFolded)) this.drawAir(frame, uploaded, layers, layers.air);
        if (isSolid) this.passes.showSolids(geometry);
        if (frame.hasVolume) {
            if (layers?.falls && !frame.keepsExposure) this.volume.measureLight(frame);
            gl.enable(gl.BLEND);
            this.volume.draw(frame, { endsAtSolids: isSolid, isLit: Boolean(layers?.falls) });
        }
        if (layers?.rotation) this.surfaces.drawRotation(frame, uploaded, layers.rotation);
    }

    // Returns the mean number of texels that the volume reads for a pixel. Draws over the picture.
    fetchesAPixel(frame: Frame): number {
        const gl = this.gl;
        this.draw({ ...frame, hasGround: false, hasVolume: false, layers: null });
        gl.disable(gl.BLEND);
        this.volume.draw({ ...frame, layers: null }, { countsFetches: true });
        const { width, height } = frame.geometry;
        const pixels = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        let fetches = 0;
        for (let i = 0; i < pixels.length; i += 4) fetches += pixels[i]! + 256 * pixels[i + 1]!;
        return fetches / (width * height);
    }

    private drawGround(
        { coverage, loaded }: UploadedGrid,
        geometry: ViewGeometry,
        grain: number,
        hasHaze: boolean,
    ): void {
        const gl = this.gl;
        const program = this.graphics.use(groundProgram(geometry.isPerspective), geometry);
        program.texture2d('coverage', 0, coverage);
        const { grid, stream } = loaded;
        program.vec2('columns', grid.nx, grid.ny);
        program.float('columnsATexel', 2 ** (stream?.level ?? 0));
        program.vec2('halfSize', geometry.box.halfXM, geometry.box.halfYM);
        program.float('ground', geometry.groundM * geometry.exaggeration);
        program.colors('page', shades.page);
        program.colors('hatch', shades.hatch);
        for (const [name, own] of [
            ['land', shades],
            ['water', shades.water],
        ] as const) {
            // With haze, the ground need not show where the air was seen from high up only.
            program.colors(`${name}Shades`, own.notSeen, hasHaze ? own.seen : own.seenAloft, own.seen, own.beyond);
        }
        this.water.bind(1, program);
        program.float('hatchScale', 1 / grain);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    private drawAir(
        frame: Frame,
        uploaded: UploadedGrid,
        layers: DrawnLayers,
        air: NonNullable<DrawnLayers['air']>,
    ): void {
        const { geometry } = frame;
        const wanted = airProgram({
            isPerspective: geometry.isPerspective,
            hasUnevenLevels: uploaded.levels !== null,
            hasHaze: layers.hasHaze,
            hasFolded: layers.hasFolded,
        });
        const program = this.graphics.use(wanted, geometry);
        bindGrid(this.gl, uploaded, frame, program);
        // Use steps over the whole depth of the grid, because the density of a veil depends on this depth.
        program.float('near', geometry.nearM);
        program.float('stepM', (geometry.farM - geometry.nearM) / frame.slices);
        this.passes.bindAir(4, air, layers, program);
        this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
    }

    showWater(mask: WaterMask | null): void {
        this.water.show(mask);
    }
    showLines(all: MapLines[]): void {
        this.lines.show(all);
    }
    // Waits until the graphics processor has drawn everything.
    finish(): void {
        this.graphics.finish();
    }

    // Begins to compile the programs of the first picture, before its data have come.
    prepare(): void {
        this.volume.prepare();
        this.graphics.begin(groundProgram(true));
        this.lines.prepare();
    }
}
