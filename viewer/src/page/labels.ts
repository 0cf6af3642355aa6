// Draws marks and their names over the picture, the most important first. Leaves out names that would overlap others.

import { ViewGeometry } from '../camera/geometry';
import { shades } from '../renderer/shades';
import { Mark } from '../scene/ground_lines';
import { Plane } from '../earth/projection';
import { fontOf, pixelRatio } from './dom';

export interface Rect {
    left: number;
    top: number;
    right: number;
    bottom: number;
}

export const overlaps = (a: Rect, b: Rect): boolean =>
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

export function haloed(pen: CanvasRenderingContext2D, text: string, x: number, y: number, color: string): void {
    pen.lineJoin = 'round';
    pen.lineWidth = 3.5;
    pen.strokeStyle = shades.halo;
    pen.strokeText(text, x, y);
    pen.fillStyle = color;
    pen.fillText(text, x, y);
}

// Returns the pixel of the page that shows a point of the plane at a height; null behind the camera.
export function pagePixel(geometry: ViewGeometry, [x, y]: Plane, heightM: number): [number, number] | null {
    const pixel = geometry.project([x, y, heightM * geometry.exaggeration]);
    return pixel && [pixel[0] / pixelRatio(), pixel[1] / pixelRatio()];
}

export function clearLabels(pen: CanvasRenderingContext2D): void {
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, pen.canvas.width, pen.canvas.height);
    pen.scale(pixelRatio(), pixelRatio());
}

// A mark with its place, in pixels of the pen.
interface PlacedMark {
    mark: Mark;
    x: number;
    y: number;
    left: number; // of the text
    rect: Rect;
}

// Places marks where they have room and are not hidden. A pixel of the pen is `ratio` pixels of the picture wide.
// `taken` are rectangles without room, in pixels of the pen.
export function placeLabels(
    pen: CanvasRenderingContext2D,
    geometry: ViewGeometry,
    marks: Mark[],
    taken: Rect[],
    ratio: number,
    isHidden: (at: Plane) => boolean = () => false,
): PlacedMark[] {
    const { width, height } = geometry;
    const full = [...taken];
    const placed: PlacedMark[] = [];
    const most = Math.max(6, Math.round((width * height) / (ratio * ratio) / 22000));
    let cities = 0;
    for (const mark of [...marks].sort((a, b) => b.rank - a.rank)) {
        if (mark.kind === 'city' && cities >= most) continue;
        const pixel = geometry.project([mark.at[0], mark.at[1], geometry.groundM * geometry.exaggeration]);
        if (!pixel) continue;
        const [x, y] = [pixel[0] / ratio, pixel[1] / ratio];
        if (x < 4 || y < 4 || x > width / ratio - 4 || y > height / ratio - 4) continue;
        pen.font = fontOfMark(mark);
        const wide = pen.measureText(mark.text).width;
        const left = mark.kind === 'ring' ? x - wide / 2 : x + 7;
        const rect: Rect = { left: Math.min(left, x - 4) - 2, top: y - 9, right: left + wide + 3, bottom: y + 9 };
        if (rect.right > width / ratio || full.some((other) => overlaps(rect, other))) continue;
        if (isHidden(mark.at)) continue;
        full.push(rect);
        if (mark.kind === 'city') ++cities;
        placed.push({ mark, x, y, left, rect });
    }
    return placed;
}

const fontOfMark = ({ kind }: Mark): string => (kind === 'site' ? fontOf(13, 'bold') : fontOf(12));

export function drawLabels(pen: CanvasRenderingContext2D, placed: PlacedMark[]): void {
    pen.textAlign = 'left';
    pen.textBaseline = 'middle';
    for (const { mark, x, y, left } of placed) {
        pen.font = fontOfMark(mark);
        if (mark.kind !== 'ring') {
            pen.beginPath();
            pen.arc(x, y, mark.kind === 'site' ? 3.5 : 2.2, 0, 2 * Math.PI);
            pen.fillStyle = shades.halo;
            pen.lineWidth = 2;
            pen.strokeStyle = shades.halo;
            pen.stroke();
            pen.fillStyle = mark.kind === 'site' ? '#ffffff' : shades.quietText;
            pen.fill();
        }
        haloed(
            pen,
            mark.text,
            left,
            y,
            mark.kind === 'city' ? shades.text : mark.kind === 'site' ? '#ffffff' : shades.quietText,
        );
    }
}
