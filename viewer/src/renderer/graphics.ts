// Makes programs and textures for all passes of a picture, and gives programs the camera.

import type { RayView } from './echo_tiles';
import { Program } from './program';
import { ShaderProgram, shaderText } from './shader_programs';

// Uploads use a unit that no program reads, so they leave all bound textures in place.
const unitOfUploads = 15;

export class Graphics {
    private programs = new Map<string, Program>();
    private begun = new Map<string, WebGLProgram>(); // programs that may still be compiling
    target: WebGLFramebuffer | null = null; // where pictures are drawn; null: the canvas

    constructor(readonly gl: WebGL2RenderingContext) {}

    get mostTexels(): number {
        return this.gl.getParameter(this.gl.MAX_3D_TEXTURE_SIZE) as number;
    }
    // Returns true if the processor draws because there is no graphics processor.
    get isSoftware(): boolean {
        const { gl } = this;
        const names = gl.getExtension('WEBGL_debug_renderer_info');
        return /swiftshader|llvmpipe|softpipe|basic render/i.test(
            String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER)),
        );
    }
    get compiledVariants(): string[] {
        return [...this.programs.keys()];
    }

    // Call after the context came back.
    forget(): void {
        this.programs.clear();
        this.begun.clear();
    }

    private compile(type: number, source: string): WebGLShader {
        const shader = this.gl.createShader(type)!;
        this.gl.shaderSource(shader, source);
        this.gl.compileShader(shader);
        return shader;
    }

    // Begins to compile a program. The first use of the program waits until it is compiled.
    begin({ name, defines, vertex, fragment }: ShaderProgram): WebGLProgram {
        const gl = this.gl;
        const program = gl.createProgram()!;
        gl.attachShader(program, this.compile(gl.VERTEX_SHADER, shaderText(vertex, defines)));
        gl.attachShader(program, this.compile(gl.FRAGMENT_SHADER, shaderText(fragment, defines)));
        gl.linkProgram(program);
        this.begun.set(name, program);
        return program;
    }

    private program(wanted: ShaderProgram): Program {
        const { name } = wanted;
        const known = this.programs.get(name);
        if (known) return known;
        const gl = this.gl;
        const linked = this.begun.get(name) ?? this.begin(wanted);
        if (!gl.getProgramParameter(linked, gl.LINK_STATUS) && !gl.isContextLost()) {
            const logs = gl.getAttachedShaders(linked)!.map((shader) => gl.getShaderInfoLog(shader));
            throw new Error(`${name}: ${gl.getProgramInfoLog(linked)} ${logs.join(' ')}`);
        }
        const program = new Program(gl, linked);
        this.programs.set(name, program);
        return program;
    }

    texture3d(
        internal: number,
        format: number,
        size: readonly number[],
        data: ArrayBufferView | null,
        filter: number,
    ): WebGLTexture {
        const gl = this.gl;
        const texture = gl.createTexture()!;
        this.beginUpload(texture);
        const type = data instanceof Uint32Array ? gl.UNSIGNED_INT : gl.UNSIGNED_BYTE;
        gl.texImage3D(gl.TEXTURE_3D, 0, internal, size[0]!, size[1]!, size[2]!, 0, format, type, data);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(gl.TEXTURE_3D, name, filter);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
            gl.texParameteri(gl.TEXTURE_3D, name, gl.CLAMP_TO_EDGE);
        return texture;
    }

    texture2d(
        internal: number,
        format: number,
        type: number,
        width: number,
        height: number,
        data: ArrayBufferView,
    ): WebGLTexture {
        const gl = this.gl;
        const texture = gl.createTexture()!;
        gl.activeTexture(gl.TEXTURE0 + unitOfUploads);
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, type, data);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
            gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
        return texture;
    }

    // Binds a texture, so that the next upload goes to it.
    beginUpload(texture: WebGLTexture): void {
        const gl = this.gl;
        gl.activeTexture(gl.TEXTURE0 + unitOfUploads);
        gl.bindTexture(gl.TEXTURE_3D, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    }

    // Makes a program current, and sets its camera.
    use(wanted: ShaderProgram, geometry: RayView): Program {
        const program = this.program(wanted);
        this.gl.useProgram(program.linked);
        program.vec2('size', geometry.width, geometry.height);
        program.vec3('eye', geometry.eye);
        program.vec3('right', geometry.right);
        program.vec3('up', geometry.up);
        program.vec3('forward', geometry.forward);
        program.float('scale', geometry.isPerspective ? geometry.focalPixels : geometry.metersPerPixel);
        return program;
    }

    // Directs drawing to the picture again after a pass has drawn to a target of its own.
    drawToPicture(): void {
        this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.target);
    }

    // Resolves when the graphics processor has drawn everything, or when the context is lost.
    async drawn(): Promise<void> {
        const { gl } = this;
        const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        if (!fence) return;
        gl.flush();
        do await new Promise((done) => window.setTimeout(done, 1));
        while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED);
        gl.deleteSync(fence);
    }
}

// Keeps textures from picture to picture, so that they are uploaded once. Releases textures that the last picture did
// not need.
export class TextureShelf {
    private held = new Map<string, { of: object; texture: WebGLTexture }>();
    private used = new Set<string>(); // names of the textures of the last picture

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

    // Call before each picture. Releases the textures that were not taken since the last call.
    clear(): void {
        for (const [name, { texture }] of this.held) {
            if (this.used.has(name)) continue;
            this.gl.deleteTexture(texture);
            this.held.delete(name);
        }
        this.used.clear();
    }
}
