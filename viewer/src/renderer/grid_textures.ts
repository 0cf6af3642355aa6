// Keeps the textures of the shown grids, and of grids of other moments of which layers draw surfaces.

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
    private shown: readonly LoadedGrid[] = []; // grids of the panes
    private uploaded = new Map<LoadedGrid, UploadedGrid>(); // also grids of which layers draw surfaces
    private gl: WebGL2RenderingContext;

    constructor(private graphics: Graphics) {
        this.gl = graphics.gl;
    }

    // Call after the context came back.
    forget(): void {
        this.uploaded.clear();
    }

    // Uploads grids, and releases the grids that were shown before.
    show(shown: readonly LoadedGrid[]): void {
        this.shown = shown;
        // Keep the atlas of a grid in parts for the next grid in parts, because such atlases usually have the
        // same size.
        const pools: UploadedGrid[] = [];
        for (const [loaded, uploaded] of this.uploaded) {
            if (shown.includes(loaded)) continue;
            this.uploaded.delete(loaded);
            if (loaded.stream) pools.push(uploaded);
            else this.release(uploaded);
        }
        for (const loaded of shown) {
            if (this.uploaded.has(loaded)) continue;
            const at = loaded.stream ? pools.findIndex((one) => one.loaded.atlas.size[0] === loaded.atlas.size[0]) : -1;
            const pool = pools.splice(at, at < 0 ? 0 : 1)[0];
            if (pool) this.release(pool, pool.atlas);
            this.uploaded.set(loaded, this.upload(loaded, pool?.atlas));
        }
        for (const pool of pools) this.release(pool);
    }

    // Releases the textures of all grids that are neither shown nor needed.
    keepOthers(needed: readonly (LoadedGrid | null | undefined)[]): void {
        for (const [loaded, uploaded] of this.uploaded) {
            if (needed.includes(loaded) || this.shown.includes(loaded)) continue;
            this.release(uploaded);
            this.uploaded.delete(loaded);
        }
    }
    // Returns the textures of a grid, and uploads them first if they are not there.
    uploadedOf(of: LoadedGrid): UploadedGrid {
        const uploaded = this.uploaded.get(of) ?? this.upload(of);
        this.uploaded.set(of, uploaded);
        return uploaded;
    }

    private release(uploaded: UploadedGrid, kept: WebGLTexture | null = null): void {
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

    // Copies bricks into the atlas of a shown grid. `texels` has the bricks of the slots that are not -1, in their
    // order.
    putBricks(of: LoadedGrid, slots: Int32Array, texels: Uint8Array): void {
        const gl = this.gl;
        const uploaded = this.uploaded.get(of);
        if (!uploaded) return;
        this.graphics.beginUpload(uploaded.atlas);
        let from = 0;
        for (const slot of slots) {
            if (slot < 0) continue;
            const [x, y, z] = placeOfSlot(slot, of.atlas.slots);
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
    putIndirection(of: LoadedGrid): void {
        const gl = this.gl;
        const uploaded = this.uploaded.get(of);
        if (!uploaded) return;
        const { bricks, indirection } = of.atlas;
        this.graphics.beginUpload(uploaded.indirection);
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
