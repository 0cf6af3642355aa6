// Keeps the mask of water in a texture.

import { Graphics } from './graphics';
import { Program } from './program';

export interface WaterMask {
    shares: Uint8Array; // share of water, of 255, row by row from the northwest corner
    width: number;
    height: number;
    halfXM: number; // half of the width that the mask covers
    halfYM: number;
}

export class WaterTexture {
    private mask: WaterMask | null = null;
    private texture: WebGLTexture | null = null;

    constructor(private graphics: Graphics) {}

    // Call after the context came back. The owner of the mask must then show the mask again.
    forget(): void {
        this.mask = this.texture = null;
    }

    // Replaces the mask. Without a mask (null), all ground is land.
    show(mask: WaterMask | null): void {
        this.graphics.gl.deleteTexture(this.texture);
        this.texture = null;
        this.mask = mask;
    }

    bind(unit: number, program: Program): void {
        this.texture ??= this.upload();
        program.texture2d('water', unit, this.texture);
        program.vec2('waterHalf', this.mask?.halfXM ?? 1, this.mask?.halfYM ?? 1);
    }

    private upload(): WebGLTexture {
        const { gl } = this.graphics;
        const { width, height, shares } = this.mask ?? { width: 1, height: 1, shares: new Uint8Array(1) };
        const texture = this.graphics.texture2d(gl.R8, gl.RED, gl.UNSIGNED_BYTE, width, height, shares);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
        return texture;
    }
}
