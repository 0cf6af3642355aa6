// Holds the pane that is being drawn. A pane is drawn as if it filled the canvas, and then copied to its place, so that
// it equals a picture of its own pixel by pixel.

import { PanePlace } from '../scene/pane_places';

export class PaneTarget {
    private held: { framebuffer: WebGLFramebuffer; color: WebGLRenderbuffer; width: number; height: number } | null =
        null;

    constructor(private gl: WebGL2RenderingContext) {}

    // Call after the context came back.
    forget(): void {
        this.held = null;
    }
    release(): void {
        if (!this.held) return;
        this.gl.deleteFramebuffer(this.held.framebuffer);
        this.gl.deleteRenderbuffer(this.held.color);
        this.held = null;
    }

    // Returns a framebuffer of this size.
    take(width: number, height: number): WebGLFramebuffer {
        const { gl } = this;
        if (this.held?.width === width && this.held.height === height) return this.held.framebuffer;
        this.release();
        const [framebuffer, color] = [gl.createFramebuffer()!, gl.createRenderbuffer()!];
        gl.bindRenderbuffer(gl.RENDERBUFFER, color);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, width, height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, color);
        this.held = { framebuffer, color, width, height };
        return framebuffer;
    }

    // Copies the pane to its place in a canvas of this height. Leaves the canvas bound.
    copy({ left, top, width, height }: PanePlace, canvasHeight: number, isEnlarged: boolean): void {
        const { gl, held } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        if (!held) return;
        gl.bindFramebuffer(gl.READ_FRAMEBUFFER, held.framebuffer);
        const bottom = canvasHeight - top - height;
        gl.blitFramebuffer(
            0,
            0,
            held.width,
            held.height,
            left,
            bottom,
            left + width,
            bottom + height,
            gl.COLOR_BUFFER_BIT,
            isEnlarged ? gl.LINEAR : gl.NEAREST,
        );
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }
}
