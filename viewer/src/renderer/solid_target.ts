// Holds the solid layers of a picture: the color and the depth of the nearest layer at each pixel. Rays through the
// volume end there.

export class SolidTarget {
    readonly color: WebGLTexture;
    readonly depth: WebGLTexture;
    private framebuffer: WebGLFramebuffer;

    constructor(
        private gl: WebGL2RenderingContext,
        readonly width: number,
        readonly height: number,
    ) {
        this.framebuffer = gl.createFramebuffer()!;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
        this.color = this.attach(gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, gl.COLOR_ATTACHMENT0);
        this.depth = this.attach(gl.DEPTH_COMPONENT32F, gl.DEPTH_COMPONENT, gl.FLOAT, gl.DEPTH_ATTACHMENT);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    private attach(internal: number, format: number, type: number, place: number): WebGLTexture {
        const { gl } = this;
        const texture = gl.createTexture()!;
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.texImage2D(gl.TEXTURE_2D, 0, internal, this.width, this.height, 0, format, type, null);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
            gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, place, gl.TEXTURE_2D, texture, 0);
        return texture;
    }

    // Directs drawing to this target. Each pixel keeps the nearest layer until end().
    begin(): void {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
        gl.viewport(0, 0, this.width, this.height);
        gl.disable(gl.BLEND);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LESS);
        gl.clearColor(0, 0, 0, 0);
        gl.clearDepth(1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    }
    end(): void {
        this.gl.disable(this.gl.DEPTH_TEST);
    }

    dispose(): void {
        this.gl.deleteFramebuffer(this.framebuffer);
        this.gl.deleteTexture(this.color);
        this.gl.deleteTexture(this.depth);
    }
}
