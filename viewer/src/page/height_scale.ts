// Draws the scale of heights beside the echo.

import { ViewGeometry } from '../camera/geometry';
import { shades } from '../renderer/shades';
import { heightAxis } from '../scene/height_axis';
import { Units } from '../tables/units';
import { fontOf } from './dom';
import { Rect, haloed } from './labels';

const room = 26; // pixels for the numbers to the left of the scale

// Draws the scale in pixels of the pen. A pixel of the pen is `pixelRatio` pixels of the picture wide. Returns the
// rectangles that the scale covers.
export function drawHeightScale(
    pen: CanvasRenderingContext2D,
    geometry: ViewGeometry,
    units: Units,
    taken: Rect[],
    pixelRatio: number,
): Rect[] {
    const isFree = (x: number, y: number) => {
        const [left, top] = [x / pixelRatio, y / pixelRatio];
        const inside =
            left > room &&
            top > 10 &&
            left < geometry.width / pixelRatio - 10 &&
            top < geometry.height / pixelRatio - 10;
        return (
            inside &&
            !taken.some(
                (rect) =>
                    left > rect.left - 6 && left - room < rect.right && top > rect.top - 8 && top < rect.bottom + 8,
            )
        );
    };
    const axis = heightAxis(geometry, units.height, pixelRatio, isFree);
    if (!axis) return [];
    const pixel = ([x, y]: [number, number]): [number, number] => [x / pixelRatio, y / pixelRatio];
    for (const [color, width] of [
        [shades.halo, 3.5],
        [shades.quietText, 1.2],
    ] as const) {
        pen.beginPath();
        pen.moveTo(...pixel(axis.foot));
        pen.lineTo(...pixel(axis.head));
        for (const { at } of axis.marks) {
            const [x, y] = pixel(at);
            pen.moveTo(x, y);
            pen.lineTo(x - 5, y);
        }
        pen.strokeStyle = color;
        pen.lineWidth = width;
        pen.stroke();
    }
    pen.font = fontOf(11);
    pen.textBaseline = 'middle';
    pen.textAlign = 'right';
    axis.marks.forEach(({ at, number }) => haloed(pen, String(number), pixel(at)[0] - 8, pixel(at)[1], shades.text));
    pen.textAlign = 'left';
    const [x, y] = pixel(axis.head);
    const unit = units.height.symbol;
    haloed(pen, unit, x + 5, y + 4, shades.quietText);
    const [footX, footY] = pixel(axis.foot);
    return [{ left: Math.min(x, footX) - room, right: Math.max(x, footX) + 8, top: y - 8, bottom: footY + 8 }];
}
