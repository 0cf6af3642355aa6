// What the passes of a picture use in common of WebGL: programs by name, textures, and the camera.

import { ViewGeometry } from '../camera/geometry';

export interface Graphics {
    readonly gl: WebGL2RenderingContext;
    program(name: string, vertex: string, fragment: string): WebGLProgram;
    // Takes a program into use, gives it the camera, and tells where its uniforms are.
    use(program: WebGLProgram, geometry: ViewGeometry): (name: string) => WebGLUniformLocation | null;
    bind(unit: number, target: number, texture: WebGLTexture | null, at: WebGLUniformLocation | null): void;
    texture2d(internal: number, format: number, type: number, width: number, height: number, data: ArrayBufferView): WebGLTexture;
    texture3d(internal: number, format: number, size: readonly number[], data: ArrayBufferView, filter: number): WebGLTexture;
}

// Textures of what is drawn now. What is drawn again is not uploaded again; what the last picture did not
// need is given back.
export class TextureShelf {
    private held = new Map<string, { of: object; texture: WebGLTexture }>();
    private used = new Set<string>(); // for the last picture

    constructor(private gl: WebGL2RenderingContext) {}

    take(name: string, of: object, make: () => WebGLTexture): WebGLTexture {
        this.used.add(name);
        const known = this.held.get(name);
        if (known?.of === of) return known.texture;
        if (known) this.gl.deleteTexture(known.texture);
        const texture = make();
        this.held.set(name, { of, texture });
        return texture;
    }

    // Another picture begins.
    clear(): void {
        for (const [name, { texture }] of this.held) {
            if (this.used.has(name)) continue;
            this.gl.deleteTexture(texture);
            this.held.delete(name);
        }
        this.used.clear();
    }
}
