// Draws what stands beside ground and volume: what is solid into a target with its depth, maxima over the
// ground, veils of air. A layer that is off has no program, no texture and no pass.

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
    isBelow: boolean; // it encloses what is at most the value
    of: LoadedGrid | null; // whose surface it is; null: of the grid that is shown
}

export interface PlacedField {
    field: FlatField;
    extent: Extent;
}

// Layers as they are drawn, made of the scene's layers and a grid.
export interface DrawnLayers {
    plane: (PlacedField & { heightM: number }) | null;
    section: Section | null;
    surface: DrawnSurface | null;
    maximum: PlacedField | null;
    sweep: DrawnSweep | null;
    crop: Crop | null;
    falls: (Falls & { placing: Placing }) | null; // the volume is lit
    air: (Air & { placing: Placing }) | null;
    hasHaze: boolean;
    hasFolded: boolean;
    mixes: boolean; // values between places may be averaged
    folded: readonly number[]; // the color of range folded air
    looks: Looks;
}

export const hasSolids = ({ plane, section, surface, sweep }: DrawnLayers): boolean =>
    Boolean(plane || section || surface || sweep);

// The direction of the sun, which stands beside the camera.
function sunOf({ right }: ViewGeometry): Vec3 {
    const azimuth = Math.atan2(right[1], -right[0]) + (sunAsideDeg * Math.PI) / 180;
    const elevation = (sunElevationDeg * Math.PI) / 180;
    return [Math.sin(azimuth) * Math.cos(elevation), Math.cos(azimuth) * Math.cos(elevation), Math.sin(elevation)];
}

const beyondGrid = 4; // the state of a field's place outside of the grid

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

    // A picture begins: what the last one did not need is given back.
    begin(hasSolids: boolean): void {
        this.shelf.clear();
        if (hasSolids) return;
        this.target?.dispose();
        this.target = null;
    }

    // -- what several layers need

    private fieldTexture(name: string, field: FlatField, inGrid: Uint8Array | null): WebGLTexture {
        const { gl } = this.graphics;
        return this.shelf.take(name, field, () => {
            const texels = new Float32Array(2 * field.values.length);
            for (let i = 0; i < field.values.length; ++i) {
                texels[2 * i] = field.values[i]!;
                texels[2 * i + 1] = inGrid && inGrid[i % field.width] === 0 ? beyondGrid : field.states[i]!;
            }
            return this.graphics.texture2d(gl.RG32F, gl.RG, gl.FLOAT, field.width, field.height, texels);
        });
    }

    bindLooks(
        unit: number,
        { looks }: DrawnLayers,
        at: (name: string) => WebGLUniformLocation | null,
        codeLine?: [number, number],
    ): void {
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
        this.graphics.bind(unit, gl.TEXTURE_2D, texture, at('looks'));
        const [zero, step] = codeLine ?? [0, 1];
        gl.uniform2f(at('lookLine'), looks.offset + looks.slope * zero, looks.slope * step);
    }

    private color(at: WebGLUniformLocation | null, rgb: readonly number[]): void {
        this.graphics.gl.uniform3f(at, rgb[0]! / 255, rgb[1]! / 255, rgb[2]! / 255);
    }

    // -- what is solid

    // The target has the size of the picture; `surface` draws into it what needs the grid's own textures.
    drawSolids(geometry: ViewGeometry, layers: DrawnLayers, surface: () => void): void {
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
        if (layers.surface) surface();
        this.target.end();
    }

    private beginSolid(
        program: ShaderProgram,
        geometry: ViewGeometry,
        layers: DrawnLayers,
    ): (name: string) => WebGLUniformLocation | null {
        const { gl } = this.graphics;
        const at = this.graphics.use(this.graphics.program(program), geometry);
        gl.uniform1f(at('exaggeration'), geometry.exaggeration);
        gl.uniform2f(at('depthRange'), geometry.nearM, geometry.farM);
        this.bindLooks(0, layers, at);
        this.color(at('seenColor'), shades.seen);
        this.color(at('foldedColor'), layers.folded);
        this.color(at('hatchColor'), shades.hatch);
        this.color(at('borderColor'), shades.border);
        return at;
    }

    // Corners with three coordinates and a place of two, as triangles or, without these, as a strip.
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

    private bindField(
        at: (name: string) => WebGLUniformLocation | null,
        texture: WebGLTexture,
        { mixes }: DrawnLayers,
    ): void {
        this.graphics.bind(1, this.graphics.gl.TEXTURE_2D, texture, at('field'));
        this.graphics.gl.uniform1i(at('mixes'), mixes ? 1 : 0);
    }

    private drawPlane(
        geometry: ViewGeometry,
        layers: DrawnLayers,
        { field, heightM, extent }: PlacedField & { heightM: number },
    ): void {
        const at = this.beginSolid(fieldProgram(geometry.isPerspective), geometry, layers);
        this.bindField(at, this.fieldTexture('plane', field, null), layers);
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
        const at = this.beginSolid(fieldProgram(geometry.isPerspective), geometry, layers);
        this.bindField(at, this.fieldTexture('section', section.field, section.inGrid), layers);
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
        const at = this.beginSolid(sweepProgram(geometry.isPerspective), geometry, layers);
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
        this.graphics.bind(1, gl.TEXTURE_2D, codes, at('codes'));
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
        this.graphics.bind(2, gl.TEXTURE_2D, numbers, at('radials'));
        gl.uniform2f(at('gateLine'), 0.5 - gates.firstGateM / gates.gateSpacingM, 1 / gates.gateSpacingM);
        gl.uniform2f(at('valueLine'), -gates.offset / gates.scale, 1 / gates.scale);
        gl.uniform1f(at('firstValue'), gates.firstValueCode);
        this.drawMesh(cone.corners, cone.triangles);
    }

    // -- what is put into the picture

    showSolids(geometry: ViewGeometry): void {
        const { gl } = this.graphics;
        const at = this.graphics.use(this.graphics.program(solidsShownProgram), geometry);
        this.graphics.bind(0, gl.TEXTURE_2D, this.target!.color, at('solidColor'));
        this.graphics.bind(1, gl.TEXTURE_2D, this.target!.depth, at('solidDepth'));
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // The sun, for what draws a surface.
    bindSun(geometry: ViewGeometry, at: (name: string) => WebGLUniformLocation | null): void {
        this.graphics.gl.uniform3fv(at('sun'), sunOf(geometry));
    }

    bindSolidDepth(unit: number, at: (name: string) => WebGLUniformLocation | null, geometry: ViewGeometry): void {
        this.graphics.bind(unit, this.graphics.gl.TEXTURE_2D, this.target!.depth, at('solidDepth'));
        this.graphics.gl.uniform2f(at('depthRange'), geometry.nearM, geometry.farM);
    }

    drawMaximum(geometry: ViewGeometry, layers: DrawnLayers, { field, extent }: PlacedField): void {
        const { gl } = this.graphics;
        const at = this.graphics.use(this.graphics.program(maximumProgram(geometry.isPerspective)), geometry);
        this.bindLooks(0, layers, at);
        this.bindField(at, this.fieldTexture('maximum', field, null), layers);
        this.color(at('seenColor'), shades.seen);
        this.color(at('foldedColor'), layers.folded);
        gl.uniform2f(at('halfSize'), geometry.box.halfXM, geometry.box.halfYM);
        gl.uniform4f(at('extent'), extent.westM, extent.southM, extent.eastM, extent.northM);
        gl.uniform1f(at('ground'), geometry.groundM * geometry.exaggeration);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    bindAir(
        unit: number,
        air: Air & { placing: Placing },
        layers: DrawnLayers,
        at: (name: string) => WebGLUniformLocation | null,
    ): void {
        const { gl } = this.graphics;
        const texture = this.shelf.take('air', air, () =>
            this.graphics.texture3d(gl.RG8, gl.RG, air.size, air.shares, gl.NEAREST),
        );
        this.graphics.bind(unit, gl.TEXTURE_3D, texture, at('air'));
        gl.uniform2fv(at('airFirst'), air.placing.first);
        gl.uniform2f(at('airCells'), airCellsAcross * 2 ** air.placing.halvings, airCellsUp);
        this.color(at('hazeColor'), shades.haze);
        this.color(at('foldedColor'), layers.folded);
    }

    // The light of a volume: where its values fall, and the sun.
    bindLight(
        unit: number,
        falls: Falls & { placing: Placing },
        geometry: ViewGeometry,
        cellM: readonly [number, number],
        levelM: number,
        at: (name: string) => WebGLUniformLocation | null,
    ): void {
        const { gl } = this.graphics;
        const [nx, ny, nz] = falls.size;
        const texture = this.shelf.take('falls', falls, () =>
            this.graphics.texture3d(gl.RGBA8, gl.RGBA, [nz, ny, nx], falls.bytes, gl.LINEAR),
        );
        this.graphics.bind(unit, gl.TEXTURE_3D, texture, at('falls'));
        const cells = fallCellsAcross * 2 ** falls.placing.halvings; // of the grid, in a coarse one
        gl.uniform2fv(at('fallsFirst'), falls.placing.first);
        gl.uniform2f(at('fallsCells'), cells * nx, cells * ny);
        // Falls reach from the coarse cell before to the one after.
        gl.uniform3f(
            at('perM'),
            0.5 / (cells * cellM[0]),
            0.5 / (cells * cellM[1]),
            0.5 / (levelM * geometry.exaggeration),
        );
        this.bindSun(geometry, at);
    }
}
