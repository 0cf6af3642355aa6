// Draws the layers other than ground and volume. Planes, sections, sweeps and surfaces are solid, and go into a target
// with depth; column maxima go over the ground. A layer that is off costs no program, no texture and no pass.

import { LoadedGrid } from '../atlas/loaded_grid';
import { Vec3, ViewGeometry } from '../camera/geometry';
import { Air, airCellsAcross, airCellsUp } from '../fields/air';
import { Falls, fallCellsAcross } from '../fields/falls';
import { FlatField } from '../fields/flat_field';
import { Section } from '../fields/section';
import { Cone } from '../fields/sweep_cone';
import { Extent, Placing } from '../scene/grid_box';
import { Crop, sunAsideDeg, sunElevationDeg } from '../scene/layers';
import { Looks, lookColumns, lookCount } from '../tables/looks';
import { PackedSweep } from '../wire/packed_sweep';
import { Graphics, TextureShelf } from './graphics';
import { Program } from './program';
import {
    ShaderProgram,
    fieldProgram,
    maximumProgram,
    radialsAcross,
    solidsShownProgram,
    sweepProgram,
} from './shader_programs';
import { shades } from './shades';
import { SolidTarget } from './solid_target';

export interface DrawnSweep {
    station: string;
    gates: PackedSweep;
    radials: Uint16Array; // by azimuth
    cone: Cone;
}

export interface DrawnSurface {
    value: number;
    isBelow: boolean; // the surface encloses values of at most `value`; otherwise of at least `value`
    of: LoadedGrid | null; // grid whose values the surface encloses; null: the shown grid
}

export interface PlacedField {
    field: FlatField;
    extent: Extent;
}

// Layers with the data to draw, which are cut from a grid.
export interface DrawnLayers {
    plane: (PlacedField & { heightM: number }) | null;
    section: Section | null;
    surface: DrawnSurface | null;
    maximum: PlacedField | null;
    sweep: DrawnSweep | null;
    crop: Crop | null;
    rotation: LoadedGrid | null; // columns of rotation (page/rotation.ts)
    falls: (Falls & { placing: Placing }) | null; // null: the volume is not lit
    air: (Air & { placing: Placing }) | null;
    hasHaze: boolean;
    hasFolded: boolean;
    mixes: boolean; // values of neighboring places may be averaged
    folded: readonly number[]; // the color of range folded air
    looks: Looks;
}

export const hasSolids = ({ plane, section, surface, sweep }: DrawnLayers): boolean =>
    Boolean(plane ?? section ?? surface ?? sweep);

// Returns the direction of the sun, which turns with the camera.
function sunOf({ right }: ViewGeometry): Vec3 {
    const azimuth = Math.atan2(right[1], -right[0]) + (sunAsideDeg * Math.PI) / 180;
    const elevation = (sunElevationDeg * Math.PI) / 180;
    return [Math.sin(azimuth) * Math.cos(elevation), Math.cos(azimuth) * Math.cos(elevation), Math.sin(elevation)];
}

const beyondGrid = 4; // state of places of a field that are outside of the grid

interface Mesh {
    array: WebGLVertexArrayObject;
    count: number;
}

export class LayerPasses {
    private shelf: TextureShelf;
    private target: SolidTarget | null = null;

    constructor(private graphics: Graphics) {
        this.shelf = new TextureShelf(graphics.gl);
    }

    forget(): void {
        this.shelf = new TextureShelf(this.graphics.gl);
        this.target = null;
    }

    // Call before each picture. Releases what the last picture did not need.
    begin(hasSolids: boolean): void {
        this.shelf.clear();
        if (hasSolids) return;
        this.target?.dispose();
        this.target = null;
    }

    // Releases all textures.
    release(): void {
        this.begin(false);
        this.shelf.clear();
    }

    // -- helpers for several layers

    private fieldTexture(name: string, field: FlatField, inGrid: Uint8Array | null): WebGLTexture {
        const { gl } = this.graphics;
        return this.shelf.take(name, field, () => {
            const texels = new Float32Array(2 * field.values.length);
            for (let i = 0; i < field.values.length; ++i) {
                texels[2 * i] = field.values[i]!;
                texels[2 * i + 1] = inGrid?.[i % field.width] === 0 ? beyondGrid : field.states[i]!;
            }
            return this.graphics.texture2d(gl.RG32F, gl.RG, gl.FLOAT, field.width, field.height, texels);
        });
    }

    bindLooks(unit: number, { looks }: DrawnLayers, program: Program, codeLine?: [number, number]): void {
        const { gl } = this.graphics;
        const texture = this.shelf.take('looks', looks, () =>
            this.graphics.texture2d(
                gl.RGBA8,
                gl.RGBA,
                gl.UNSIGNED_BYTE,
                lookColumns,
                lookCount / lookColumns,
                looks.rgba,
            ),
        );
        program.texture2d('looks', unit, texture);
        const [zero, step] = codeLine ?? [0, 1];
        program.vec2('lookLine', looks.offset + looks.slope * zero, looks.slope * step);
    }

    // -- solid layers

    // Draws the solid layers into the target. `drawSurface` draws the surface, which needs the textures of the grid.
    drawSolids(geometry: ViewGeometry, layers: DrawnLayers, drawSurface: (surface: DrawnSurface) => void): void {
        const { gl } = this.graphics;
        const { width, height } = geometry;
        if (this.target?.width !== width || this.target.height !== height) {
            this.target?.dispose();
            this.target = new SolidTarget(gl, width, height);
        }
        this.target.begin();
        if (layers.plane) this.drawPlane(geometry, layers, layers.plane);
        if (layers.section) this.drawSection(geometry, layers, layers.section);
        if (layers.sweep) this.drawSweep(geometry, layers, layers.sweep);
        if (layers.surface) drawSurface(layers.surface);
        this.target.end();
        this.graphics.drawToPicture();
    }

    private beginSolid(wanted: ShaderProgram, geometry: ViewGeometry, layers: DrawnLayers): Program {
        const program = this.graphics.use(wanted, geometry);
        program.float('exaggeration', geometry.exaggeration);
        program.vec2('depthRange', geometry.nearM, geometry.farM);
        this.bindLooks(0, layers, program);
        program.colors('seenColor', shades.seen);
        program.colors('foldedColor', layers.folded);
        program.colors('hatchColor', shades.hatch);
        program.colors('borderColor', shades.border);
        return program;
    }

    // Draws a mesh. Each corner has three coordinates and a place of two numbers. If `triangles` is null, the corners
    // are a strip of triangles.
    private drawMesh(corners: Float32Array, triangles: Uint32Array | null): void {
        const { gl } = this.graphics;
        const mesh: Mesh = { array: gl.createVertexArray()!, count: triangles?.length ?? corners.length / 5 };
        const buffers = [gl.createBuffer(), triangles ? gl.createBuffer() : null];
        gl.bindVertexArray(mesh.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers[0]!);
        gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STREAM_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 20, 0);
        gl.enableVertexAttribArray(1);
        gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 20, 12);
        if (triangles) {
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[1]!);
            gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STREAM_DRAW);
            gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
        } else gl.drawArrays(gl.TRIANGLE_STRIP, 0, mesh.count);
        gl.bindVertexArray(null);
        gl.deleteVertexArray(mesh.array);
        for (const buffer of buffers) gl.deleteBuffer(buffer);
    }

    private bindField(program: Program, texture: WebGLTexture, { mixes }: DrawnLayers): void {
        program.texture2d('field', 1, texture);
        program.flag('mixes', mixes);
    }

    private drawPlane(
        geometry: ViewGeometry,
        layers: DrawnLayers,
        { field, heightM, extent }: PlacedField & { heightM: number },
    ): void {
        const program = this.beginSolid(fieldProgram(geometry.isPerspective), geometry, layers);
        this.bindField(program, this.fieldTexture('plane', field, null), layers);
        // Cells of a halved grid may reach beyond the grid.
        const { halfXM, halfYM } = geometry.box;
        const [west, east] = [Math.max(-halfXM, extent.westM), Math.min(halfXM, extent.eastM)];
        const [south, north] = [Math.max(-halfYM, extent.southM), Math.min(halfYM, extent.northM)];
        const column = (x: number) => (field.width * (x - extent.westM)) / (extent.eastM - extent.westM);
        const row = (y: number) => (field.height * (y - extent.southM)) / (extent.northM - extent.southM);
        const corner = (x: number, y: number) => [x, y, heightM, column(x), row(y)];
        this.drawMesh(
            new Float32Array([
                ...corner(west, south),
                ...corner(east, south),
                ...corner(west, north),
                ...corner(east, north),
            ]),
            null,
        );
    }

    private drawSection(geometry: ViewGeometry, layers: DrawnLayers, section: Section): void {
        const program = this.beginSolid(fieldProgram(geometry.isPerspective), geometry, layers);
        this.bindField(program, this.fieldTexture('section', section.field, section.inGrid), layers);
        const corners = section.ends.flatMap(([x, y], i) => [
            x,
            y,
            section.bottomM,
            i,
            0,
            x,
            y,
            section.topM,
            i,
            section.field.height,
        ]);
        this.drawMesh(new Float32Array(corners), null);
    }

    private drawSweep(geometry: ViewGeometry, layers: DrawnLayers, { gates, radials, cone }: DrawnSweep): void {
        const { gl } = this.graphics;
        const program = this.beginSolid(sweepProgram(geometry.isPerspective), geometry, layers);
        const isShort = gates.codes instanceof Uint16Array;
        const codes = this.shelf.take('gates', gates, () =>
            this.graphics.texture2d(
                isShort ? gl.R16UI : gl.R8UI,
                gl.RED_INTEGER,
                isShort ? gl.UNSIGNED_SHORT : gl.UNSIGNED_BYTE,
                gates.gateStride,
                gates.azimuthsDeg.length,
                gates.codes,
            ),
        );
        program.texture2d('codes', 1, codes);
        const numbers = this.shelf.take('radials', gates, () => {
            const pairs = new Uint16Array(2 * radials.length);
            radials.forEach((radial, i) => pairs.set([radial, gates.gateCounts[radial] ?? 0], 2 * i));
            return this.graphics.texture2d(
                gl.RG16UI,
                gl.RG_INTEGER,
                gl.UNSIGNED_SHORT,
                radialsAcross,
                radials.length / radialsAcross,
                pairs,
            );
        });
        program.texture2d('radials', 2, numbers);
        program.vec2('gateLine', 0.5 - gates.firstGateM / gates.gateSpacingM, 1 / gates.gateSpacingM);
        program.vec2('valueLine', -gates.offset / gates.scale, 1 / gates.scale);
        program.float('firstValue', gates.firstValueCode);
        program.float('ambiguous', gates.ambiguousCode);
        this.drawMesh(cone.corners, cone.triangles);
    }

    // -- passes into the picture

    showSolids(geometry: ViewGeometry): void {
        const { gl } = this.graphics;
        if (!this.target) return;
        const program = this.graphics.use(solidsShownProgram, geometry);
        program.texture2d('solidColor', 0, this.target.color);
        program.texture2d('solidDepth', 1, this.target.depth);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // Binds the sun, for programs that light a surface.
    bindSun(geometry: ViewGeometry, program: Program): void {
        program.vec3('sun', sunOf(geometry));
    }

    bindSolidDepth(unit: number, program: Program, geometry: ViewGeometry): void {
        if (this.target) program.texture2d('solidDepth', unit, this.target.depth);
        program.vec2('depthRange', geometry.nearM, geometry.farM);
    }

    drawMaximum(geometry: ViewGeometry, layers: DrawnLayers, { field, extent }: PlacedField): void {
        const { gl } = this.graphics;
        const program = this.graphics.use(maximumProgram(geometry.isPerspective), geometry);
        this.bindLooks(0, layers, program);
        this.bindField(program, this.fieldTexture('maximum', field, null), layers);
        program.colors('seenColor', shades.seen);
        program.colors('foldedColor', layers.folded);
        program.vec2('halfSize', geometry.box.halfXM, geometry.box.halfYM);
        program.vec4('extent', [extent.westM, extent.southM, extent.eastM, extent.northM]);
        program.float('ground', geometry.groundM * geometry.exaggeration);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    bindAir(unit: number, air: Air & { placing: Placing }, layers: DrawnLayers, program: Program): void {
        const { gl } = this.graphics;
        const texture = this.shelf.take('air', air, () =>
            this.graphics.texture3d(gl.RG8, gl.RG, air.size, air.shares, gl.NEAREST),
        );
        program.texture3d('air', unit, texture);
        program.vec2('airFirst', ...air.placing.first);
        program.vec2('airCells', airCellsAcross * 2 ** air.placing.halvings, airCellsUp);
        program.colors('hazeColor', shades.haze);
        program.colors('foldedColor', layers.folded);
    }

    // Binds the sun and the falls of the volume (fields/falls.ts), by which the program lights the volume.
    bindLight(
        unit: number,
        falls: Falls & { placing: Placing },
        geometry: ViewGeometry,
        cellM: readonly [number, number],
        levelM: number,
        program: Program,
    ): void {
        const { gl } = this.graphics;
        const [nx, ny, nz] = falls.size;
        const texture = this.shelf.take('falls', falls, () =>
            this.graphics.texture3d(gl.RGBA8, gl.RGBA, [nz, ny, nx], falls.bytes, gl.LINEAR),
        );
        program.texture3d('falls', unit, texture);
        const cells = fallCellsAcross * 2 ** falls.placing.halvings; // cells of the grid across a coarse cell
        program.vec2('fallsFirst', ...falls.placing.first);
        program.vec2('fallsCells', cells * nx, cells * ny);
        // A fall is the difference between the two neighbors of a coarse cell, so it is over two coarse cells.
        program.vec3('perM', [
            0.5 / (cells * cellM[0]),
            0.5 / (cells * cellM[1]),
            0.5 / (levelM * geometry.exaggeration),
        ]);
        this.bindSun(geometry, program);
    }
}
