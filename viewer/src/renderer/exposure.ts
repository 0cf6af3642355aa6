// Finds the exposure of a lit picture, a factor of its light. With the exposure, echo has the same mean lightness as
// without light (render/volume/lit_layer.h). The exposure is measured in a small picture.

import { ViewGeometry } from '../camera/geometry';
import { RayView } from './echo_tiles';

const stride = 5; // a pixel of the small picture covers stride x stride pixels
const [leastExposure, mostExposure] = [0.7, 1.4];
const halvings = 10;

function litLightness(l: number, factor: number): number {
    if (factor < 1) return l * Math.max(0.5, 1 - 0.9 * (1 - factor));
    return l + Math.max(0, 0.98 - l) * (1 - Math.exp(-1.44 * (factor - 1)));
}

// Returns the exposure for pixels of four bytes: lightness, half of the light's factor, opacity (each of 255), and a
// byte that is not used. Returns 1 if every pixel is clear.
export function exposureOf(pixels: Uint8Array): number {
    let [low, high] = [leastExposure, mostExposure];
    let isEmpty = true;
    for (let step = 0; step < halvings; ++step) {
        const middle = 0.5 * (low + high);
        let lighter = 0;
        for (let i = 0; i < pixels.length; i += 4) {
            if (pixels[i + 2] === 0) continue;
            isEmpty = false;
            const l = pixels[i]! / 255;
            lighter += pixels[i + 2]! * (litLightness(l, (middle * 2 * pixels[i + 1]!) / 255) - l);
        }
        if (lighter > 0) high = middle;
        else low = middle;
    }
    return isEmpty ? 1 : 0.5 * (low + high);
}

function smallView(geometry: ViewGeometry): RayView {
    const { width, height, eye, right, up, forward, focalPixels, metersPerPixel, isPerspective } = geometry;
    return {
        width: width / stride,
        height: height / stride,
        focalPixels: focalPixels / stride,
        metersPerPixel: metersPerPixel * stride,
        eye,
        right,
        up,
        forward,
        isPerspective,
    };
}

interface Target {
    framebuffer: WebGLFramebuffer;
    texture: WebGLTexture;
    pixels: WebGLBuffer; // the small picture, once it is drawn
    width: number;
    height: number;
}

export class Exposure {
    value = 1;
    private target: Target | null = null;

    constructor(private gl: WebGL2RenderingContext) {}

    forget(): void {
        this.target = null;
    }

    release(): void {
        if (!this.target) return;
        this.gl.deleteFramebuffer(this.target.framebuffer);
        this.gl.deleteTexture(this.target.texture);
        this.gl.deleteBuffer(this.target.pixels);
        this.target = null;
    }

    private targetOf(width: number, height: number): Target {
        const { gl } = this;
        if (this.target?.width === width && this.target.height === height) return this.target;
        this.release();
        const texture = gl.createTexture()!;
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
        const framebuffer = gl.createFramebuffer()!;
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
        const pixels = gl.createBuffer()!;
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, pixels);
        gl.bufferData(gl.PIXEL_PACK_BUFFER, 4 * width * height, gl.STREAM_READ);
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
        return (this.target = { framebuffer, texture, pixels, width, height });
    }

    // Begins to draw the small picture that is measured. `draw` draws it into a framebuffer that stays bound.
    begin(geometry: ViewGeometry, draw: (small: RayView) => void): void {
        const { gl } = this;
        const small = smallView(geometry);
        const [width, height] = [Math.ceil(small.width), Math.ceil(small.height)];
        const { framebuffer, pixels } = this.targetOf(width, height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        gl.viewport(0, 0, width, height);
        gl.clearColor(0, 0, 0, 0);
        gl.clear(gl.COLOR_BUFFER_BIT);
        draw(small);
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, pixels);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    }

    // Sets `value` by the small picture. Waits if the graphics processor has not drawn it.
    end(): void {
        const { gl, target } = this;
        if (!target) return;
        const pixels = new Uint8Array(4 * target.width * target.height);
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, target.pixels);
        gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, pixels);
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
        this.value = exposureOf(pixels);
    }
}
