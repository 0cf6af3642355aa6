// Draws shapes of other programs, such as warnings, on the ground of the picture: lines with a halo, and points with
// labels (render/map/shape_marks.h).

import { ViewGeometry } from '../../camera/geometry';
import { planeOf } from '../../earth/projection';
import { dark } from '../../facts';
import { Pixel, lightnessOf, pathOf, seenLines } from '../../overlay/shape_path';
import { Rgb, Shape } from '../../overlay/shapes';
import { shades } from '../../renderer/shades';
import { GridPlace } from '../../wire/packed_grid';
import { fontOf } from '../dom';
import { Rect, haloed, overlaps } from '../labels';

const dotRadius = 3;
const haloRoom = 1;
const labelHeight = 16;
const mostLabels = 1000; // that may find a place
const mostParts = 200_000; // of all edges
const mostProjectingMs = 40;

const cssOf = ([red, green, blue]: Rgb): string => `rgb(${red} ${green} ${blue})`;
const rgbOf = ({ color }: Shape): Rgb => color ?? dark.text;

// Returns the color of halos or of letters, whichever differs more in lightness. So a dark line has a light halo.
function haloOf(color: Rgb): string {
    const lightness = lightnessOf(color);
    const apart = (other: readonly number[]) => Math.abs(lightnessOf(other) - lightness);
    const [red, green, blue] = apart(dark.halo) < apart(dark.text) ? dark.text : dark.halo;
    return cssOf([red, green, blue]);
}

function dot(pen: CanvasRenderingContext2D, [x, y]: Pixel, radius: number, color: string): void {
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fillStyle = color;
    pen.fill();
}

function drawLines(pen: CanvasRenderingContext2D, lines: Pixel[][], shape: Shape): void {
    pen.beginPath();
    for (const line of lines) line.forEach((pixel, i) => (i === 0 ? pen.moveTo(...pixel) : pen.lineTo(...pixel)));
    for (const [room, color] of [
        [haloRoom, haloOf(rgbOf(shape))],
        [0, cssOf(rgbOf(shape))],
    ] as const) {
        pen.lineWidth = shape.width + 2 * room;
        pen.strokeStyle = color;
        pen.stroke();
    }
}

// Returns a free place for a label beside its dot; null if every such place is taken.
function placeOfLabel([x, y]: Pixel, width: number, taken: readonly Rect[], room: Rect): Rect | null {
    const apart = dotRadius + 4;
    const half = labelHeight / 2;
    const corners: Pixel[] = [
        [x + apart, y - half],
        [x - apart - width, y - half],
        [x - width / 2, y - apart - labelHeight + 2],
        [x - width / 2, y + apart - 2],
    ];
    const rects = corners.map(([left, top]) => ({ left, top, right: left + width, bottom: top + labelHeight }));
    const isFree = (one: Rect) =>
        one.left >= room.left &&
        one.top >= room.top &&
        one.right <= room.right &&
        one.bottom <= room.bottom &&
        !taken.some((other) => overlaps(one, other));
    return rects.find(isFree) ?? null;
}

export class ShapeMarks {
    private paths = new WeakMap<Shape, Float64Array>();
    private place = ''; // grid of the paths

    // Projects shapes onto the plane of a grid for a short time. Returns true if all are projected.
    project(shapes: readonly Shape[], grid: GridPlace): boolean {
        const { projection, nx, ny, centerDeg, spacing, parallelsDeg, offsetCells } = grid;
        const place = [projection, nx, ny, centerDeg, spacing, parallelsDeg, offsetCells].join();
        if (this.place !== place) this.paths = new WeakMap();
        this.place = place;
        const endMs = performance.now() + mostProjectingMs;
        const plane = planeOf(grid);
        for (const shape of shapes) {
            if (this.paths.has(shape)) continue;
            if (performance.now() > endMs) return false;
            this.paths.set(shape, pathOf(shape.places, plane, mostParts / shapes.length));
        }
        return true;
    }

    // Draws the shapes that are projected, in pixels of the pen, each of which is `ratio` pixels of the picture wide.
    // `taken` are rectangles that have no room for labels. Returns the rectangles that dots and labels take.
    draw(
        pen: CanvasRenderingContext2D,
        geometry: ViewGeometry,
        ratio: number,
        taken: readonly Rect[],
        shapes: readonly Shape[],
    ): Rect[] {
        const dots: { shape: Shape; at: Pixel }[] = [];
        const groundM = geometry.groundM * geometry.exaggeration;
        const [right, bottom] = [geometry.width / ratio, geometry.height / ratio];
        pen.lineJoin = 'round';
        pen.lineCap = 'round';
        for (const shape of shapes) {
            const path = this.paths.get(shape);
            if (!path) continue;
            if (shape.places.length > 1) {
                const lines = seenLines(path, geometry, ratio);
                if (lines.length > 0) drawLines(pen, lines, shape);
                continue;
            }
            const seen = geometry.project([path[0]!, path[1]!, groundM]);
            const [x, y] = [(seen?.[0] ?? NaN) / ratio, (seen?.[1] ?? NaN) / ratio];
            if (x >= 0 && y >= 0 && x <= right && y <= bottom) dots.push({ shape, at: [x, y] });
        }
        return this.drawDots(pen, dots, taken, { left: 0, top: 0, right, bottom });
    }

    private drawDots(
        pen: CanvasRenderingContext2D,
        dots: { shape: Shape; at: Pixel }[],
        taken: readonly Rect[],
        room: Rect,
    ): Rect[] {
        const own: Rect[] = [];
        pen.font = fontOf(12, 'bold');
        pen.textAlign = 'left';
        pen.textBaseline = 'middle';
        for (const { shape, at } of dots) {
            dot(pen, at, dotRadius + haloRoom, haloOf(rgbOf(shape)));
            dot(pen, at, dotRadius, cssOf(rgbOf(shape)));
            const radius = dotRadius + haloRoom;
            own.push({ left: at[0] - radius, top: at[1] - radius, right: at[0] + radius, bottom: at[1] + radius });
        }
        for (const { shape, at } of dots.filter((one) => one.shape.label !== '').slice(0, mostLabels)) {
            const rect = placeOfLabel(at, pen.measureText(shape.label).width, [...taken, ...own], room);
            if (!rect) continue;
            own.push(rect);
            haloed(pen, shape.label, rect.left, (rect.top + rect.bottom) / 2, shades.text);
        }
        return own;
    }
}
