// Draws ground, map lines, layers and volume with WebGL2.

import { Atlas, paddedEdge, placeOfSlot } from '../atlas/atlas';
import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry, heightRange } from '../camera/geometry';
import { MapLines } from '../scene/ground_lines';
import { columnShare, croppedBox } from '../scene/layers';
import { cellSizeM } from '../earth/projection';
import { ColorTable } from '../wire/color_tables';
import { Transfer, makeTransfer } from '../tables/transfer';
import { PackedGrid } from '../wire/packed_grid';
import { RayView, TilePass, blockEnds, tilesOf } from './echo_tiles';
import { Exposure } from './exposure';
import { Graphics } from './graphics';
import { DrawnLayers, DrawnSurface, LayerPasses, hasSolids } from './layer_passes';
import { LinePass } from './line_pass';
import { Program } from './program';
import {
    SurfaceVariant,
    VolumeVariant,
    airProgram,
    groundProgram,
    surfaceProgram,
    volumeProgram,
} from './shader_programs';
import { shades } from './shades';
import { WaterMask, WaterTexture } from './water_texture';

export interface Frame {
    geometry: ViewGeometry;
    slices: number;
    grain: number; // the picture is enlarged this many times along each side
    isNearest: boolean; // cells are not interpolated
    opacity: number;
    table: ColorTable;
    leastValue: number; // values below it are not shown
    hasVolume: boolean;
    hasGround: boolean;
    layers?: DrawnLayers | null;
    keepsExposure?: boolean; // the exposure of the last picture is used again
}

// Inputs of a transfer function except the step: table, first value and step of codes, opacity, and least value.
type TransferKey = readonly [ColorTable, number, number, number, number];

interface Uploaded {
    loaded: LoadedGrid;
    atlas: WebGLTexture;
    indirection: WebGLTexture;
    coverage: WebGLTexture;
    levels: WebGLTexture | null;
    levelRange: [number, number];
}

type WantedOfVolume = Pick<VolumeVariant, 'countsFetches' | 'endsAtSolids' | 'isLit' | 'measuresLight'>;

const levelTexels = 1024;
// A transfer function is for steps of one length. If the length changes by at most this factor, the optical depths are
// scaled; otherwise the transfer function is made again.
const mostStretch = 1.25;

export class Renderer {
    private gl: WebGL2RenderingContext;
    private graphics: Graphics;
    private uploaded: Uploaded | null = null;
    private others = new Map<LoadedGrid, Uploaded>(); // grids of other moments, of which surfaces are drawn
    private passes: LayerPasses;
    private exposure: Exposure;
    private lines: LinePass;
    private water: WaterTexture;
    private tiles: TilePass;
    private transferTexture: WebGLTexture | null = null;
    private transfer: { made: Transfer; stepM: number; key: TransferKey } | null = null;

    constructor(readonly canvas: HTMLCanvasElement) {
        const gl = canvas.getContext('webgl2', { antialias: false, preserveDrawingBuffer: true, alpha: false });
        if (!gl) throw new Error('webgl2');
        this.gl = gl;
        this.graphics = new Graphics(gl);
        this.passes = new LayerPasses(this.graphics);
        this.lines = new LinePass(this.graphics);
        this.water = new WaterTexture(this.graphics);
        this.tiles = new TilePass(gl);
        this.exposure = new Exposure(gl);
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
        this.tiles.forget();
        this.uploaded = null;
        this.others.clear();
        this.passes.forget();
        this.exposure.forget();
        this.transferTexture = null;
        this.transfer = null;
    }

    show(loaded: LoadedGrid): void {
        const old = this.uploaded;
        // Keep the atlas of a grid in parts for the next grid in parts, because all such atlases have the same size.
        const pool = loaded.stream && old?.loaded.stream ? old.atlas : null;
        this.release(old, pool);
        this.uploaded = this.upload(loaded, pool);
    }

    private release(uploaded: Uploaded | null, kept: WebGLTexture | null = null): void {
        if (!uploaded) return;
        for (const texture of [uploaded.atlas, uploaded.indirection, uploaded.coverage, uploaded.levels]) {
            if (texture !== kept) this.gl.deleteTexture(texture);
        }
    }

    private keepOthers(needed: (LoadedGrid | null | undefined)[]): void {
        for (const [loaded, uploaded] of this.others) {
            if (needed.includes(loaded)) continue;
            this.release(uploaded);
            this.others.delete(loaded);
        }
    }
    private uploadedOf(shown: Uploaded, of: LoadedGrid | null): Uploaded {
        if (!of || of === shown.loaded) return shown;
        const uploaded = this.others.get(of) ?? this.upload(of);
        this.others.set(of, uploaded);
        return uploaded;
    }

    private upload(loaded: LoadedGrid, pool: WebGLTexture | null = null): Uploaded {
        const gl = this.gl;
        const { atlas, grid, coverage, stream } = loaded;
        const heights = heightRange(grid.levelsM);
        const range: [number, number] = [heights.bottomM, heights.topM];
        const halved = (cells: number) => Math.ceil(cells / 2 ** (stream?.level ?? 0));
        return {
            loaded,
            atlas: pool ?? this.graphics.texture3d(gl.RG8, gl.RG, atlas.size, stream ? null : atlas.texels, gl.LINEAR),
            indirection: this.graphics.texture3d(gl.R32UI, gl.RED_INTEGER, atlas.bricks, atlas.indirection, gl.NEAREST),
            coverage: this.graphics.texture2d(
                gl.R8UI,
                gl.RED_INTEGER,
                gl.UNSIGNED_BYTE,
                halved(grid.nx),
                halved(grid.ny),
                coverage,
            ),
            levels: hasUnevenLevels(grid) ? this.levelTable(grid, range) : null,
            levelRange: range,
        };
    }

    // Copies bricks into the atlas. `texels` has the bricks of the slots that are not -1, in their order.
    putBricks(slots: Int32Array, texels: Uint8Array): void {
        const gl = this.gl;
        if (!this.uploaded) return;
        this.graphics.beginUpload(this.uploaded.atlas);
        let from = 0;
        for (const slot of slots) {
            if (slot < 0) continue;
            const [x, y, z] = placeOfSlot(slot, this.uploaded.loaded.atlas.slots);
            gl.texSubImage3D(
                gl.TEXTURE_3D,
                0,
                x,
                y,
                z,
                paddedEdge,
                paddedEdge,
                paddedEdge,
                gl.RG,
                gl.UNSIGNED_BYTE,
                texels,
                from,
            );
            from += 2 * paddedEdge ** 3;
        }
    }

    // Uploads the atlas's indirection. Call after a change of the indirection.
    putIndirection(): void {
        const gl = this.gl;
        if (!this.uploaded) return;
        const { bricks, indirection } = this.uploaded.loaded.atlas;
        this.graphics.beginUpload(this.uploaded.indirection);
        gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, ...bricks, gl.RED_INTEGER, gl.UNSIGNED_INT, indirection);
    }

    // Returns a texture with the level, a number with a fraction, at each of many evenly spaced heights.
    private levelTable(grid: PackedGrid, [low, high]: [number, number]): WebGLTexture {
        const table = new Float32Array(levelTexels);
        const levels = grid.levelsM;
        let i = 0;
        for (let t = 0; t < levelTexels; ++t) {
            const height = low + ((t + 0.5) / levelTexels) * (high - low);
            while (i + 2 < levels.length && height >= levels[i + 1]!) ++i;
            const level = i + (height - levels[i]!) / (levels[Math.min(i + 1, levels.length - 1)]! - levels[i]!);
            table[t] = Math.min(levels.length - 1, Math.max(0, Number.isFinite(level) ? level : 0));
        }
        return this.graphics.texture2d(this.gl.R32F, this.gl.RED, this.gl.FLOAT, levelTexels, 1, table);
    }

    draw(frame: Frame): void {
        const gl = this.gl;
        const { geometry } = frame;
        if (this.canvas.width !== geometry.width || this.canvas.height !== geometry.height) {
            this.canvas.width = geometry.width;
            this.canvas.height = geometry.height;
        }
        const layers = frame.layers ?? null;
        const { uploaded } = this;
        const isSolid = layers !== null && uploaded !== null && hasSolids(layers);
        this.passes.begin(isSolid);
        this.keepOthers([layers?.surface?.of, layers?.rotation]);
        if (isSolid)
            this.passes.drawSolids(geometry, layers, (surface) => this.drawSurface(frame, uploaded, layers, surface));
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
            if (layers?.falls && !frame.keepsExposure) this.measureLight(frame);
            gl.enable(gl.BLEND);
            this.drawVolume(frame, { endsAtSolids: isSolid, isLit: Boolean(layers?.falls) });
        }
        if (layers?.rotation) this.drawRotation(frame, uploaded, layers.rotation);
    }

    // Returns the mean number of texels that the volume reads for a pixel. Draws over the picture.
    fetchesAPixel(frame: Frame): number {
        const gl = this.gl;
        this.draw({ ...frame, hasGround: false, hasVolume: false, layers: null });
        gl.disable(gl.BLEND);
        this.drawVolume({ ...frame, layers: null }, { countsFetches: true });
        const { width, height } = frame.geometry;
        const pixels = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        let fetches = 0;
        for (let i = 0; i < pixels.length; i += 4) fetches += pixels[i]! + 256 * pixels[i + 1]!;
        return fetches / (width * height);
    }

    // Measures the exposure of the lit echo in a small picture.
    private measureLight(frame: Frame): void {
        const { gl } = this;
        this.exposure.measure(frame.geometry, (small) => {
            gl.disable(gl.BLEND);
            this.drawVolume(frame, { isLit: true, measuresLight: true }, small);
        });
        gl.viewport(0, 0, frame.geometry.width, frame.geometry.height);
    }

    private drawGround({ coverage, loaded }: Uploaded, geometry: ViewGeometry, grain: number, hasHaze: boolean): void {
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

    // Gives a program the textures and the geometry of a grid, and the steps of its rays.
    private bindGrid(
        { loaded, atlas, indirection, levels, levelRange }: Uploaded,
        frame: Frame,
        program: Program,
    ): void {
        const gl = this.gl;
        const { grid } = loaded;
        const { box, exaggeration } = frame.geometry;
        const [nearM, farM] = slicedDepths(loaded, frame.geometry);
        const [cellWidth, cellHeight] = cellSizeM(grid);
        program.texture3d('atlas', 0, atlas);
        const filter = frame.isNearest ? gl.NEAREST : gl.LINEAR;
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(gl.TEXTURE_3D, name, filter);
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

    // Draws the volume. `view` is the camera of the picture, or of a smaller picture of the same view.
    private drawVolume(frame: Frame, wanted: WantedOfVolume, view: RayView = frame.geometry): void {
        const { geometry, layers } = frame;
        const { uploaded } = this;
        if (!uploaded || uploaded.loaded.atlas.brickCount === 0) return;
        const { loaded, levels } = uploaded;
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
        this.bindGrid(uploaded, frame, program);
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

    private drawAir(frame: Frame, uploaded: Uploaded, layers: DrawnLayers, air: NonNullable<DrawnLayers['air']>): void {
        const { geometry } = frame;
        const wanted = airProgram({
            isPerspective: geometry.isPerspective,
            hasUnevenLevels: uploaded.levels !== null,
            hasHaze: layers.hasHaze,
            hasFolded: layers.hasFolded,
        });
        const program = this.graphics.use(wanted, geometry);
        this.bindGrid(uploaded, frame, program);
        // Use steps over the whole depth of the grid, because the density of a veil depends on this depth.
        program.float('near', geometry.nearM);
        program.float('stepM', (geometry.farM - geometry.nearM) / frame.slices);
        this.passes.bindAir(4, air, layers, program);
        this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
    }

    private drawSurface(
        frame: Frame,
        shown: Uploaded,
        layers: DrawnLayers,
        { value, isBelow, of }: DrawnSurface,
    ): void {
        const surface = this.uploadedOf(shown, of);
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
        surface: Uploaded,
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
        this.bindGrid(surface, frame, program);
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
    private drawRotation(frame: Frame, shown: Uploaded, of: LoadedGrid): void {
        const surface = this.uploadedOf(shown, of);
        if (surface.loaded.atlas.brickCount === 0) return;
        this.gl.enable(this.gl.BLEND);
        for (const isBelow of [false, true]) {
            const value = isBelow ? -columnShare : columnShare;
            const program = this.useSurface(frame, surface, value, { isBelow, isColumn: true });
            program.colors('columnColor', shades.turning[isBelow ? 1 : 0]!);
            this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
        }
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
        this.graphics.begin(volumeProgram({ isPerspective: true, hasUnevenLevels: false }));
        this.graphics.begin(groundProgram(true));
        this.lines.prepare();
    }
}

// Returns the depths of the first and the last slice. For a grid in parts, slices are only in its visible part, which
// may be a small part of the box.
function slicedDepths(loaded: LoadedGrid, geometry: ViewGeometry): [number, number] {
    return loaded.stream ? geometry.shownDepths : [geometry.nearM, geometry.farM];
}

// Returns the mean distance between levels, at least 1 m.
function levelSpacingM({ levelsM }: PackedGrid): number {
    const last = levelsM.length - 1;
    return Math.max(1, (levelsM[last]! - levelsM[0]!) / Math.max(1, last));
}

function slotStrides({ slots }: Atlas): [number, number, number] {
    return [slots[0], slots[1], slots[0] * slots[1]];
}
function perTexel({ size }: Atlas): [number, number, number] {
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

function hasUnevenLevels(grid: PackedGrid): boolean {
    if (grid.nz < 3) return false;
    const spacing = grid.levelsM[1]! - grid.levelsM[0]!;
    for (let z = 2; z < grid.nz; ++z) {
        if (Math.abs(grid.levelsM[z]! - grid.levelsM[z - 1]! - spacing) > 1e-6 * spacing) return true;
    }
    return false;
}
