// Draws ground, map lines, layers and volume with WebGL2, in one frame or in several panes.

import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { MapLines } from '../scene/ground_lines';
import { Frame } from './frame';
import { Graphics } from './graphics';
import { GridTextures, UploadedGrid } from './grid_textures';
import { bindGrid } from './grid_uniforms';
import { DrawnLayers, LayerPasses, hasSolids } from './layer_passes';
import { LinePass } from './line_pass';
import { PanePasses } from './pane_passes';
import { PaneTarget } from './pane_target';
import { Parts, Picture, inStrips } from './picture';
import { airProgram, groundProgram } from './shader_programs';
import { shades } from './shades';
import { WaterMask, WaterTexture } from './water_texture';

const gapColor = [0.227, 0.271, 0.329] as const; // between panes; #3a4554, as borders of the page

export class Renderer {
    private gl: WebGL2RenderingContext;
    private graphics: Graphics;
    private grids: GridTextures;
    private passes: PanePasses[]; // of each pane
    private paneTarget: PaneTarget;
    private laidOut = ''; // the places of the panes on the canvas
    private lines: LinePass;
    private water: WaterTexture;

    constructor(readonly canvas: HTMLCanvasElement) {
        const gl = canvas.getContext('webgl2', { antialias: false, preserveDrawingBuffer: true, alpha: false });
        if (!gl) throw new Error('webgl2');
        this.gl = gl;
        this.graphics = new Graphics(gl);
        this.grids = new GridTextures(this.graphics);
        this.passes = [new PanePasses(this.graphics, this.grids)];
        this.paneTarget = new PaneTarget(gl);
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
        this.paneTarget.forget();
        this.passes = [new PanePasses(this.graphics, this.grids)];
        this.laidOut = '';
    }

    // Takes the grids of all panes.
    show(loaded: readonly LoadedGrid[]): void {
        this.grids.show(loaded);
    }
    // Copies bricks into the atlas of a shown grid. `texels` has the bricks of the slots that are not -1, in
    // their order.
    putBricks(of: LoadedGrid, slots: Int32Array, texels: Uint8Array): void {
        this.grids.putBricks(of, slots, texels);
    }
    // Uploads the atlas's indirection. Call after a change of the indirection.
    putIndirection(of: LoadedGrid): void {
        this.grids.putIndirection(of);
    }

    private resize(width: number, height: number): void {
        if (this.canvas.width === width && this.canvas.height === height) return;
        this.canvas.width = width;
        this.canvas.height = height;
    }

    // Draws a picture. A whole picture is drawn at once, except that its light is measured first. Any other picture is
    // drawn in strips, and each frame is on the canvas only when it is complete.
    *draw(picture: Picture, isWhole: boolean): Parts {
        const { panes } = picture;
        const frames = panes.map(({ frame }) => frame);
        this.begin(frames);
        const isDirect = isWhole && panes.length === 1;
        if (isDirect) this.paneTarget.release();
        for (const [i, frame] of frames.entries()) {
            const passes = (this.passes[i] ??= new PanePasses(this.graphics, this.grids));
            if (frame?.hasVolume && frame.layers?.falls && !frame.keepsExposure)
                yield* passes.volume.measureLight(frame);
            if (frame && !isDirect && !isWhole) yield* this.drawStrips(frame, passes);
            this.layOut(picture);
            if (frame && isDirect) this.drawFrame(frame, passes);
            else if (frame) {
                if (isWhole) this.drawToTarget(frame, passes, [0, frame.geometry.height]);
                this.paneTarget.copy(panes[i]!.place, picture.height, frame.grain > 1);
            }
        }
    }

    private *drawStrips(frame: Frame, passes: PanePasses): Parts {
        yield* inStrips(frame.geometry.height, (from, to) => this.drawToTarget(frame, passes, [from, to]));
    }
    // Draws rows of a frame into the target of panes.
    private drawToTarget(frame: Frame, passes: PanePasses, [from, to]: [number, number]): void {
        const { gl, graphics } = this;
        const { width, height } = frame.geometry;
        graphics.target = this.paneTarget.take(width, height);
        graphics.drawToPicture();
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(0, from, width, to - from);
        this.drawFrame(frame, passes);
        gl.disable(gl.SCISSOR_TEST);
        graphics.target = null;
        graphics.drawToPicture();
    }

    // Gives the canvas the size of the picture. Clears it if panes are at other places than before.
    private layOut({ width, height, panes }: Picture): void {
        const { gl } = this;
        const laidOut = JSON.stringify([width, height, panes.map(({ frame, place }) => [frame !== null, place])]);
        if (laidOut === this.laidOut) return;
        this.laidOut = laidOut;
        this.resize(width, height);
        if (panes.length === 1) return;
        gl.clearColor(...gapColor, 1);
        gl.clear(gl.COLOR_BUFFER_BIT);
    }

    // Releases what the last picture needed and these frames do not need.
    private begin(frames: readonly (Frame | null)[]): void {
        for (const passes of this.passes.splice(frames.length)) passes.release();
        this.grids.keepOthers(frames.flatMap((frame) => [frame?.layers?.surface?.of, frame?.layers?.rotation]));
    }

    private drawFrame(frame: Frame, { layers: passes, volume, surfaces }: PanePasses): void {
        const gl = this.gl;
        const { geometry } = frame;
        const layers = frame.layers ?? null;
        const uploaded = this.grids.uploadedOf(frame.loaded);
        const isSolid = layers !== null && hasSolids(layers);
        passes.begin(isSolid);
        if (isSolid) passes.drawSolids(geometry, layers, (surface) => surfaces.draw(frame, uploaded, layers, surface));
        gl.viewport(0, 0, geometry.width, geometry.height);
        gl.disable(gl.BLEND);
        gl.clearColor(
            frame.hasGround ? shades.page[0] / 255 : 0,
            frame.hasGround ? shades.page[1] / 255 : 0,
            frame.hasGround ? shades.page[2] / 255 : 0,
            1,
        );
        gl.clear(gl.COLOR_BUFFER_BIT);
        if (frame.hasGround) {
            this.drawGround(uploaded, geometry, frame.grain, layers?.hasHaze ?? false);
        }
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        if (layers?.maximum) passes.drawMaximum(geometry, layers, layers.maximum);
        if (frame.hasGround && !geometry.isMap) this.lines.draw(geometry, frame.grain);
        if (layers?.air && (layers.hasHaze || layers.hasFolded))
            this.drawAir(frame, passes, uploaded, layers, layers.air);
        if (isSolid) passes.showSolids(geometry);
        if (frame.hasVolume) {
            volume.draw(frame, { endsAtSolids: isSolid, isLit: Boolean(layers?.falls) });
        }
        // On a map, lines are over the echo, as in stills. In other views, echo stands above the ground.
        if (frame.hasGround && geometry.isMap) this.lines.draw(geometry, frame.grain);
        if (layers?.rotation) surfaces.drawRotation(frame, layers.rotation);
    }

    // Returns the mean number of texels that the volume reads for a pixel. Draws over the picture.
    fetchesAPixel(frame: Frame): number {
        const gl = this.gl;
        const { width, height } = frame.geometry;
        this.resize(width, height);
        this.drawFrame({ ...frame, hasGround: false, hasVolume: false, layers: null }, this.passes[0]!);
        gl.disable(gl.BLEND);
        this.passes[0]!.volume.draw({ ...frame, layers: null }, { countsFetches: true });
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
        passes: LayerPasses,
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
        passes.bindAir(4, air, layers, program);
        this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
    }

    showWater(mask: WaterMask | null): void {
        this.water.show(mask);
    }
    showLines(all: MapLines[]): void {
        this.lines.show(all);
    }
    // Resolves when the graphics processor has drawn everything.
    drawn(): Promise<void> {
        return this.graphics.drawn();
    }

    // Begins to compile the programs of the first picture, before its data have come.
    prepare(): void {
        this.passes[0]!.volume.prepare();
        this.graphics.begin(groundProgram(true));
        this.lines.prepare();
    }
}
