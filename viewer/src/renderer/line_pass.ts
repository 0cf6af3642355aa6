// Draws lines of the map. Each segment is a strip on the ground, whose width depends on the kind of line.

import { MapLines, shownKinds } from '../scene/ground_lines';
import { ViewGeometry } from '../camera/geometry';
import { Graphics } from './graphics';
import { lineProgram } from './shader_programs';
import { shades } from './shades';

interface UploadedLines {
    lines: MapLines;
    array: WebGLVertexArrayObject;
    buffers: WebGLBuffer[];
    count: number; // number of vertices to draw
}

// Widths of the lines, in pixels.
const widths: Record<MapLines['kind'], number> = {
    county: 0.7,
    state: 1.3,
    lake: 1,
    country: 1.6,
    coast: 1.3,
    interstate: 1.2,
    highway: 0.7,
    ring: 1,
    border: 1,
};

// Each corner of a segment's strip has both ends of the segment. Instances would need less memory, but without a
// graphics processor, beginning an instance takes as long as drawing hundreds of corners.
const cornersASegment = 4;
const triangles = [0, 1, 2, 1, 3, 2];

export function cornersOf(segments: Float32Array): Float32Array {
    const corners = new Float32Array(cornersASegment * segments.length);
    for (let i = 0; i < corners.length; ++i)
        corners[i] = segments[4 * Math.floor(i / (4 * cornersASegment)) + (i % 4)]!;
    return corners;
}
export function trianglesOf(segmentCount: number): Uint32Array {
    return Uint32Array.from(
        { length: triangles.length * segmentCount },
        (_, i) => cornersASegment * Math.floor(i / triangles.length) + triangles[i % triangles.length]!,
    );
}

export class LinePass {
    private uploaded: UploadedLines[] = [];

    constructor(private graphics: Graphics) {}

    prepare(): void {
        this.graphics.begin(lineProgram);
    }
    // Call after the context came back.
    forget(): void {
        this.uploaded = [];
    }

    // Replaces the lines.
    show(all: MapLines[]): void {
        const { gl } = this.graphics;
        for (const { array, buffers } of this.uploaded) {
            gl.deleteVertexArray(array);
            for (const buffer of buffers) gl.deleteBuffer(buffer);
        }
        this.uploaded = all.map((lines) => {
            const array = gl.createVertexArray()!;
            const buffers = [gl.createBuffer()!, gl.createBuffer()!];
            const indices = trianglesOf(lines.segments.length / 4);
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, buffers[0]!);
            gl.bufferData(gl.ARRAY_BUFFER, cornersOf(lines.segments), gl.STATIC_DRAW);
            gl.enableVertexAttribArray(0);
            gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[1]!);
            gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
            gl.bindVertexArray(null);
            return { lines, array, buffers, count: indices.length };
        });
    }

    // Draws the lines that are not too dense. The picture is shown `grain` times as wide and high, so lines are drawn
    // that much thinner.
    draw(geometry: ViewGeometry, grain: number): void {
        const { gl } = this.graphics;
        if (this.uploaded.length === 0) return;
        const program = this.graphics.use(lineProgram, geometry);
        program.float('ground', geometry.groundM * geometry.exaggeration);
        program.flag('isPerspective', geometry.isPerspective);
        const shown = shownKinds(geometry, grain);
        for (const { lines, array, count } of this.uploaded) {
            if (!shown.has(lines.kind)) continue;
            const rgba = shades[lines.kind];
            program.vec4('look', [rgba[0] / 255, rgba[1] / 255, rgba[2] / 255, rgba[3] / 255]);
            program.float('width', widths[lines.kind] / grain);
            gl.bindVertexArray(array);
            gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
        }
        gl.bindVertexArray(null);
    }
}
