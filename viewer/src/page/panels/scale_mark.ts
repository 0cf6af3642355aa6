// Draws a bar with the scale of the picture at its center, also in a saved picture.

import { planeOf } from '../../earth/projection';
import { shades } from '../../renderer/shades';
import { scaleBar } from '../../scene/scale_bar';
import { App } from '../app';
import { fontOf, make, pixelRatio, textScale } from '../dom';
import { Drawing } from '../drawing';
import { haloed } from '../labels';
import { panelTexts } from '../later_texts';

const tick = 5; // pixels

export function addScale(app: App, drawing: Drawing): void {
    const place = make('div', { id: 'scale' });
    drawing.labels.after(place);
    drawing.addFurniture((pen, geometry) => {
        const { shown, state } = app;
        if (!shown || !state.hasGround) return;
        const { right, bottom, width } = place.getBoundingClientRect();
        const { distance } = state.units;
        const bar = scaleBar(geometry, planeOf(shown.loaded.grid), distance, width * pixelRatio());
        if (!bar) return;
        const long = bar.pixels / pixelRatio() / textScale();
        pen.translate(right, bottom);
        pen.scale(textScale(), textScale());
        for (const [color, wide] of [
            [shades.halo, 4],
            [shades.text, 1.5],
        ] as const) {
            pen.beginPath();
            pen.moveTo(-long, -tick);
            pen.lineTo(-long, 0);
            pen.lineTo(0, 0);
            pen.lineTo(0, -tick);
            pen.strokeStyle = color;
            pen.lineWidth = wide;
            pen.stroke();
        }
        pen.font = fontOf(12);
        pen.textAlign = 'right';
        const told = `${bar.number} ${distance.symbol}`;
        haloed(pen, geometry.isPerspective ? panelTexts.atCenter(told) : told, 0, -tick - 4, shades.text);
    });
}
