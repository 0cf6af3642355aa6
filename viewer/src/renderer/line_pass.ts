// Lines of the map, each segment a strip on the ground as wide as its kind.

import { ViewGeometry } from '../camera/geometry';
import { Graphics } from './graphics';
import { lineFragment, lineVertex } from './shaders';
import { shades } from './shades';

export interface MapLines {
    kind: 'county' | 'state' | 'lake' | 'country' | 'coast' | 'ring' | 'border';
    segments: Float32Array; // x, y, x, y in meters from the middle
}

interface UploadedLines {
    lines: MapLines;
    array: WebGLVertexArrayObject;
    buffer: WebGLBuffer;
    count: number;
}

// In pixels.
const widths: Record<MapLines['kind'], number> = { county: 0.7, state: 1.3, lake: 1, country: 1.6, coast: 1.3, ring: 1, border: 1 };

export class LinePass {
    private uploaded: UploadedLines[] = [];

    constructor(private graphics: Graphics) {}

    prepare(): void {
        this.graphics.begin('lines', lineVertex, lineFragment);
    }
    // After the context came back.
    forget(): void {
        this.uploaded = [];
    }

    // Takes other lines; those before are given back.
    show(all: MapLines[]): void {
        const { gl } = this.graphics;
        for (const { array, buffer } of this.uploaded) {
            gl.deleteVertexArray(array);
            gl.deleteBuffer(buffer);
        }
        this.uploaded = all.map(lines => {
            const array = gl.createVertexArray()!;
            const buffer = gl.createBuffer()!;
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.bufferData(gl.ARRAY_BUFFER, lines.segments, gl.STATIC_DRAW);
            gl.enableVertexAttribArray(0);
            gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
            gl.vertexAttribDivisor(0, 1);
            gl.bindVertexArray(null);
            return { lines, array, buffer, count: lines.segments.length / 4 };
        });
    }

    // `grain`: the picture is shown so many times as wide and high.
    draw(geometry: ViewGeometry, grain: number): void {
        const { gl } = this.graphics;
        if (this.uploaded.length === 0) return;
        const at = this.graphics.use(this.graphics.program('lines', lineVertex, lineFragment), geometry);
        gl.uniform1f(at('ground'), geometry.groundM * geometry.exaggeration);
        gl.uniform1i(at('isPerspective'), geometry.isPerspective ? 1 : 0);
        for (const { lines, array, count } of this.uploaded) {
            const rgba = shades[lines.kind];
            gl.uniform4f(at('look'), rgba[0] / 255, rgba[1] / 255, rgba[2] / 255, rgba[3] / 255);
            gl.uniform1f(at('width'), widths[lines.kind] / grain);
            gl.bindVertexArray(array);
            gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
        }
        gl.bindVertexArray(null);
    }
}
