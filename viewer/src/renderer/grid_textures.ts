// Keeps the textures of the shown grid, and of grids of other moments of which layers draw surfaces.

import { paddedEdge, placeOfSlot } from '../atlas/atlas';
import { LoadedGrid } from '../atlas/loaded_grid';
import { heightRange } from '../camera/geometry';
import { PackedGrid } from '../wire/packed_grid';
import { Graphics } from './graphics';

export interface UploadedGrid {
    loaded: LoadedGrid;
    atlas: WebGLTexture;
    indirection: WebGLTexture;
    coverage: WebGLTexture;
    levels: WebGLTexture | null; // null if levels are evenly spaced
    levelRange: [number, number];
}

const levelTexels = 1024;

export class GridTextures {
    shown: UploadedGrid | null = null;
    private others = new Map<LoadedGrid, UploadedGrid>();
    private gl: WebGL2RenderingContext;

    constructor(private graphics: Graphics) {
        this.gl = graphics.gl;
    }

    // Call after the context came back.
    forget(): void {
        this.shown = null;
        this.others.clear();
    }

    show(loaded: LoadedGrid): void {
        const old = this.shown;
        // Keep the atlas of a grid in parts for the next grid in parts, because all such atlases have the same size.
        const pool = loaded.stream && old?.loaded.stream ? old.atlas : null;
        this.release(old, pool);
        this.shown = this.upload(loaded, pool);
    }

    // Releases the textures of all other grids but those that are needed.
    keepOthers(needed: (LoadedGrid | null | undefined)[]): void {
        for (const [loaded, uploaded] of this.others) {
            if (needed.includes(loaded)) continue;
            this.release(uploaded);
            this.others.delete(loaded);
        }
    }
    // Returns the textures of a grid, which may be the shown grid. Returns those of the shown grid for null.
    uploadedOf(shown: UploadedGrid, of: LoadedGrid | null): UploadedGrid {
        if (!of || of === shown.loaded) return shown;
        const uploaded = this.others.get(of) ?? this.upload(of);
        this.others.set(of, uploaded);
        return uploaded;
    }

    private release(uploaded: UploadedGrid | null, kept: WebGLTexture | null = null): void {
        if (!uploaded) return;
        for (const texture of [uploaded.atlas, uploaded.indirection, uploaded.coverage, uploaded.levels]) {
            if (texture !== kept) this.gl.deleteTexture(texture);
        }
    }

    private upload(loaded: LoadedGrid, pool: WebGLTexture | null = null): UploadedGrid {
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

    // Copies bricks into the atlas of the shown grid. `texels` has the bricks of the slots that are not -1, in their
    // order.
    putBricks(slots: Int32Array, texels: Uint8Array): void {
        const gl = this.gl;
        if (!this.shown) return;
        this.graphics.beginUpload(this.shown.atlas);
        let from = 0;
        for (const slot of slots) {
            if (slot < 0) continue;
            const [x, y, z] = placeOfSlot(slot, this.shown.loaded.atlas.slots);
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
        if (!this.shown) return;
        const { bricks, indirection } = this.shown.loaded.atlas;
        this.graphics.beginUpload(this.shown.indirection);
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
}

function hasUnevenLevels(grid: PackedGrid): boolean {
    if (grid.nz < 3) return false;
    const spacing = grid.levelsM[1]! - grid.levelsM[0]!;
    for (let z = 2; z < grid.nz; ++z) {
        if (Math.abs(grid.levelsM[z]! - grid.levelsM[z - 1]! - spacing) > 1e-6 * spacing) return true;
    }
    return false;
}
