// Draws the beam glyphs of the shown sweep, and their key.

import { BeamGlyph, Pixel, discRadius, pixelsPerMps, planGlyphs } from '../beam_glyphs';
import { planeOf } from '../../earth/projection';
import { shades } from '../../renderer/shades';
import { sweepMoment } from '../../scene/layers';
import { shownUnit } from '../../tables/units';
import { isVelocity } from '../../wire/moments';
import { App } from '../app';
import { fontOf, pixelRatio, textScale } from '../dom';
import { Drawing } from '../drawing';
import { Rect, haloed, overlaps } from '../labels';
import { plotTexts } from '../later_texts';

const headLength = 4.8;
const headHalfWidth = 2.6;
const lineWidth = 1.4;
const nearMps = 20; // the key shows a round speed near this speed

function putDiscs(pen: CanvasRenderingContext2D, glyphs: Pick<BeamGlyph, 'gate' | 'axes'>[], scale: number): void {
    for (const { gate, axes } of glyphs) {
        pen.beginPath();
        for (let i = 0; i < 28; ++i) {
            const [c, s] = [Math.cos((i * Math.PI) / 14), Math.sin((i * Math.PI) / 14)];
            pen.lineTo(gate[0] + c * axes[0][0] + s * axes[1][0], gate[1] + c * axes[0][1] + s * axes[1][1]);
        }
        pen.closePath();
        pen.lineWidth = 2.2 * scale;
        pen.strokeStyle = 'rgb(8 10 14 / 0.35)';
        pen.stroke();
        pen.globalAlpha = 0.28;
        pen.fillStyle = shades.text;
        pen.fill();
        pen.globalAlpha = 0.75;
        pen.lineWidth = 0.8 * scale;
        pen.strokeStyle = shades.text;
        pen.stroke();
        pen.globalAlpha = 1;
    }
}

// Draws lines and heads, `room` wider on all sides.
function putLines(
    pen: CanvasRenderingContext2D,
    glyphs: Pick<BeamGlyph, 'gate' | 'tip'>[],
    scale: number,
    room: number,
    color: string,
): void {
    pen.strokeStyle = color;
    pen.fillStyle = color;
    pen.lineWidth = lineWidth * scale + 2 * room;
    for (const { gate, tip } of glyphs) {
        const [dx, dy] = [tip[0] - gate[0], tip[1] - gate[1]];
        const length = Math.hypot(dx, dy);
        pen.beginPath();
        if (length === 0) {
            pen.arc(...gate, 1.5 * scale + room, 0, 2 * Math.PI);
            pen.fill();
            continue;
        }
        // The line ends inside its head, so that the head stays sharp.
        pen.moveTo(...gate);
        pen.lineTo(gate[0] + 0.9 * dx, gate[1] + 0.9 * dy);
        pen.stroke();
        const [x, y] = [dx / length, dy / length];
        const size = scale * Math.min(1, 0.5 + (0.5 * length) / (headLength * scale));
        const end: Pixel = [tip[0] + 1.6 * room * x, tip[1] + 1.6 * room * y];
        const back = headLength * size + 2.6 * room;
        const half = headHalfWidth * size + 1.3 * room;
        pen.beginPath();
        pen.moveTo(...end);
        pen.lineTo(end[0] - back * x - half * y, end[1] - back * y + half * x);
        pen.lineTo(end[0] - back * x + half * y, end[1] - back * y - half * x);
        pen.fill();
    }
}

function putGlyphs(pen: CanvasRenderingContext2D, glyphs: BeamGlyph[], scale: number): void {
    putDiscs(pen, glyphs, scale);
    putLines(pen, glyphs, scale, 0.9 * scale, 'rgb(8 10 14)');
    putLines(pen, glyphs, scale, 0, shades.text);
}

// Draws the key into the first corner of the picture that no part of the page covers.
function putKey({ state }: App, pen: CanvasRenderingContext2D, [right, bottom]: Pixel, scale: number): void {
    const unit = shownUnit('m/s', state.units);
    const shown = 10 * Math.round((nearMps * unit.perStored) / 10);
    const length = ((pixelsPerMps * shown) / unit.perStored) * scale;
    const words = [plotTexts.glyphAlong(`${shown} ${unit.symbol}`), plotTexts.glyphAcross];
    pen.font = fontOf(11 * scale);
    const row = 16 * scale;
    const width = length + 24 * scale + Math.max(...words.map((one) => pen.measureText(one).width));
    const height = 2 * row;
    const covered: Rect[] = [...document.querySelectorAll('header, footer, section, #bar, #legend, #compass')]
        .map((one) => one.getBoundingClientRect())
        .filter((rect) => rect.width > 0);
    const places: Pixel[] = [];
    for (let y = bottom - height - 8; y > 8; y -= row) places.push([12, y], [right - width - 12, y]);
    const [x, y] =
        places.find(
            ([left, top]) =>
                !covered.some((one) =>
                    overlaps(one, { left: left - 4, top: top - 4, right: left + width + 4, bottom: top + height + 4 }),
                ),
        ) ?? places[0]!;
    pen.fillStyle = `rgb(${shades.page.slice(0, 3).join(' ')} / 0.65)`;
    pen.fillRect(x - 6, y - 4, width + 12, height + 8);
    pen.textBaseline = 'middle';
    const line = { gate: [x + 4, y + row / 2] as Pixel, tip: [x + 4 + length, y + row / 2] as Pixel };
    const radius = discRadius * scale;
    const disc = {
        gate: [x + 4 + length / 2, y + 1.5 * row] as Pixel,
        axes: [
            [0, radius],
            [0.36 * radius, 0],
        ] as [Pixel, Pixel],
    };
    putLines(pen, [line], scale, 0.9 * scale, 'rgb(8 10 14)');
    putLines(pen, [line], scale, 0, shades.text);
    putDiscs(pen, [disc], scale);
    words.forEach((one, i) => haloed(pen, one, x + length + 16 * scale, y + (i + 0.5) * row, shades.text));
}

export function addGlyphs(app: App, drawing: Drawing): void {
    drawing.addOverlay((pen, geometry, { drawn, shown, state, isActive }) => {
        const sweep = drawn?.sweep;
        const moment = sweepMoment(state.layers, shown?.moment ?? '');
        const { dataset } = document.documentElement;
        if (isActive) dataset['glyphs'] = '0';
        if (!state.layers.hasGlyphs || !sweep || !shown || !isVelocity(moment)) return;
        const [ratio, scale] = [pixelRatio(), 1.15 * textScale()];
        const glyphs = planGlyphs(geometry, sweep, planeOf(shown.loaded.grid), ratio, scale);
        putGlyphs(pen, glyphs, scale);
        putKey(app, pen, [geometry.width / ratio, geometry.height / ratio], scale);
        if (isActive) dataset['glyphs'] = String(glyphs.length);
    });
}
