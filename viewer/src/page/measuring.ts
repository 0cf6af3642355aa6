// Measures distances and areas between places that the user clicks.

import { ViewGeometry } from '../camera/geometry';
import { shades } from '../renderer/shades';
import { areaM2, legOf } from '../earth/measure';
import { planeOf } from '../earth/projection';
import { distanceText, heightText } from '../tables/units';
import { App } from './app';
import { fontOf, textScale } from './dom';
import { Drawing } from './drawing';
import { haloed, pagePixel } from './labels';
import { Picked, pick } from './picked';
import { Tool } from './pointers';
import { panelTexts } from './later_texts';

export type Measure = 'distance' | 'area';

type End = Pick<Picked, 'place' | 'heightM'>;

// Returns the place of a solid layer under a pixel, or else of the ground. The volume is translucent, so a click on it
// does not tell which depth the user means.
function endAt(drawing: Drawing, x: number, y: number): End | null {
    const picked = pick(drawing, x, y, false);
    if (picked?.layer !== 'volume') return picked;
    const { shown } = drawing.pane;
    const geometry = drawing.geometry();
    const at = geometry?.ground(x + 0.5, y + 0.5);
    return shown && geometry && at
        ? { place: planeOf(shown.loaded.grid).toPlace(at), heightM: geometry.groundM }
        : null;
}

export class MeasureTool implements Tool {
    private points: End[] = [];
    private ahead: End | null = null; // place under the pointer

    constructor(
        private app: App,
        private drawing: Drawing,
        readonly measure: Measure,
        private tell: (text: string) => void,
        private ended: () => void,
    ) {
        tell(panelTexts.tools.hint(measure));
    }

    click(x: number, y: number): void {
        const end = endAt(this.drawing, x, y);
        if (!end) return;
        // Begin a new distance with the third click.
        if (this.measure === 'distance' && this.points.length === 2) this.points = [];
        this.points.push(end);
        this.ahead = null;
        this.put();
    }
    hover(x: number, y: number): void {
        const isOpen = this.points.length > 0 && !(this.measure === 'distance' && this.points.length === 2);
        if (!isOpen) return;
        this.ahead = endAt(this.drawing, x, y);
        this.put();
    }
    end(): void {
        this.points = [];
        this.ahead = null;
        this.ended();
    }

    private get all(): End[] {
        return this.ahead ? [...this.points, this.ahead] : this.points;
    }

    private put(): void {
        const { units } = this.app.state;
        const all = this.all;
        if (all.length < 2) this.tell(panelTexts.tools.hint(this.measure));
        else if (this.measure === 'distance') {
            const [from, to] = [all[0]!, all[1]!];
            const { distanceM, azimuthDeg } = legOf(from.place, to.place);
            const apartM = to.heightM - from.heightM;
            this.tell(
                panelTexts.tools.distance(
                    distanceText(distanceM, units),
                    Math.round(azimuthDeg) % 360,
                    apartM === 0 ? '' : panelTexts.tools.higher(apartM, heightText(Math.abs(apartM), units)),
                ),
            );
        } else {
            const around = all.reduce(
                (sum, one, i) => sum + legOf(one.place, all[(i + 1) % all.length]!.place).distanceM,
                0,
            );
            const side = units.distance.si;
            this.tell(
                panelTexts.tools.area(
                    `${Number((areaM2(all.map((one) => one.place)) / side ** 2).toPrecision(4))} ${units.distance.symbol}²`,
                    distanceText(around, units),
                ),
            );
        }
        this.drawing.drawMarks();
    }

    draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry): void {
        const { shown } = this.app;
        if (!shown || this.points.length === 0) return;
        const plane = planeOf(shown.loaded.grid);
        const pixels = this.all.map((one) => {
            const at = plane.toPlane(one.place);
            return at && pagePixel(geometry, at, one.heightM);
        });
        for (const [color, width] of [
            [shades.halo, 5],
            ['#7db8f0', 2],
        ] as const) {
            pen.beginPath();
            for (const pixel of pixels) if (pixel) pen.lineTo(...pixel);
            if (this.measure === 'area' && pixels.length > 2) pen.closePath();
            pen.strokeStyle = color;
            pen.lineWidth = width;
            pen.stroke();
        }
        const scale = textScale();
        pen.font = fontOf(12 * scale, 'bold');
        pixels.forEach((pixel, i) => {
            if (!pixel) return;
            pen.beginPath();
            pen.arc(pixel[0], pixel[1], 3.5 * scale, 0, 2 * Math.PI);
            pen.fillStyle = '#7db8f0';
            pen.fill();
            if (this.measure === 'distance') haloed(pen, 'AB'[i]!, pixel[0] + 7 * scale, pixel[1], shades.text);
        });
    }
}
