// Sets uniforms of a linked program, whose locations are looked up once. Setting a uniform that the program's variant
// does not have does nothing.

export class Program {
    private locations = new Map<string, WebGLUniformLocation>();

    constructor(
        private gl: WebGL2RenderingContext,
        readonly linked: WebGLProgram,
    ) {
        const count = gl.getProgramParameter(linked, gl.ACTIVE_UNIFORMS) as number;
        for (let i = 0; i < count; ++i) {
            const { name } = gl.getActiveUniform(linked, i)!;
            this.locations.set(name.replace('[0]', ''), gl.getUniformLocation(linked, name)!);
        }
    }

    private at(name: string): WebGLUniformLocation | null {
        return this.locations.get(name) ?? null;
    }

    float(name: string, value: number): void {
        this.gl.uniform1f(this.at(name), value);
    }
    floats(name: string, values: Float32Array): void {
        this.gl.uniform1fv(this.at(name), values);
    }
    vec2(name: string, x: number, y: number): void {
        this.gl.uniform2f(this.at(name), x, y);
    }
    vec3(name: string, [x, y, z]: readonly [number, number, number]): void {
        this.gl.uniform3f(this.at(name), x, y, z);
    }
    vec4(name: string, [x, y, z, w]: readonly [number, number, number, number]): void {
        this.gl.uniform4f(this.at(name), x, y, z, w);
    }
    uint(name: string, value: number): void {
        this.gl.uniform1ui(this.at(name), value);
    }
    flag(name: string, value: boolean): void {
        this.gl.uniform1i(this.at(name), value ? 1 : 0);
    }
    // Sets a color or an array of colors, whose channels are from 0 to 255. Alpha is ignored.
    colors(name: string, ...colors: (readonly number[])[]): void {
        const channels = colors.flatMap((color) => color.slice(0, 3).map((channel) => channel / 255));
        this.gl.uniform3fv(this.at(name), channels);
    }
    texture2d(name: string, unit: number, texture: WebGLTexture | null): void {
        this.texture(name, unit, this.gl.TEXTURE_2D, texture);
    }
    // Leaves the texture bound, so that its parameters can be set.
    texture3d(name: string, unit: number, texture: WebGLTexture | null): void {
        this.texture(name, unit, this.gl.TEXTURE_3D, texture);
    }
    private texture(name: string, unit: number, target: number, texture: WebGLTexture | null): void {
        this.gl.activeTexture(this.gl.TEXTURE0 + unit);
        this.gl.bindTexture(target, texture);
        this.gl.uniform1i(this.at(name), unit);
    }
}
