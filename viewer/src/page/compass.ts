// Shows where north is in the picture, also in a saved picture. A press turns north up. Once the view has changed, a
// button leads back to the first view.

import { shades } from '../renderer/shades';
import { App } from './app';
import { button, fontOf, labeledButton, textScale } from './dom';
import { Drawing } from './drawing';
import { haloed } from './labels';
import { texts } from './texts';

const northUpDeg = 180; // seen from the south
const needle = 14; // pixels
const halfWidth = 5;

export function addCompass(app: App, drawing: Drawing): void {
    const place = labeledButton('compass', '', texts.northUp, () => {
        app.moved({ ...app.state.camera, azimuthDeg: northUpDeg });
        drawing.picture.focus();
    });
    const reset = button('reset-view', texts.resetView, () => {
        app.resetView();
        drawing.picture.focus();
    });
    drawing.labels.after(place, reset);
    const putReset = () => (reset.hidden = !app.shown || app.isFirstView);
    app.on(['shown', 'view', 'camera'], putReset);
    putReset();
    drawing.addFurniture((pen) => {
        const { left, top, width, height } = place.getBoundingClientRect();
        pen.translate(left + width / 2, top + height / 2);
        pen.scale(textScale(), textScale());
        const angle = ((northUpDeg - app.state.camera.azimuthDeg) * Math.PI) / 180;
        pen.rotate(angle);
        for (const [color, way] of [
            [shades.text, -1],
            [shades.quietText, 1],
        ] as const) {
            pen.beginPath();
            pen.moveTo(-halfWidth, 0);
            pen.lineTo(0, way * needle);
            pen.lineTo(halfWidth, 0);
            pen.closePath();
            pen.strokeStyle = shades.halo;
            pen.lineWidth = 2;
            pen.stroke();
            pen.fillStyle = color;
            pen.fill();
        }
        pen.rotate(-angle);
        pen.font = fontOf(10, 'bold');
        pen.textAlign = 'center';
        pen.textBaseline = 'middle';
        haloed(pen, 'N', 1.5 * needle * Math.sin(angle), -1.5 * needle * Math.cos(angle), shades.text);
    });
}
