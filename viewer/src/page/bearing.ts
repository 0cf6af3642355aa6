// Draws a line from the nearest radar to a place, and the ring of its range.

import { ViewGeometry } from '../camera/geometry';
import { nearestTo } from '../fields/beam_reading';
import { Place, destination, planeOf } from '../earth/projection';
import { shades } from '../renderer/shades';
import { distanceText } from '../tables/units';
import { App } from './app';
import { fontOf, textScale } from './dom';
import { Drawing } from './drawing';
import { haloed, pagePixel } from './labels';
import { panelTexts } from './later_texts';
import { pick } from './picked';
import { Tool } from './pointers';

const lineColor = '#7db8f0';
const ringPoints = 120;

export class BearingTool implements Tool {
    private place: Place | null = null;
    private isPinned = false; // a click has chosen the place

    constructor(
        private app: App,
        private drawing: Drawing,
        private tell: (text: string) => void,
        private ended: () => void,
    ) {
        tell(panelTexts.tools.bearingHint);
    }

    // Chooses the place; another click lets the place follow the pointer again.
    click(x: number, y: number): void {
        this.isPinned = !this.isPinned;
        this.point(x, y);
    }
    hover(x: number, y: number): void {
        if (!this.isPinned) this.point(x, y);
    }
    end(): void {
        this.place = null;
        this.ended();
    }

    private point(x: number, y: number): void {
        this.place = pick(this.drawing, x, y, false)?.place ?? null;
        const way = this.way();
        this.tell(way ? way.text : panelTexts.tools.bearingHint);
        this.drawing.drawMarks();
    }

    // Returns the nearest radar, and distance and direction of the place from it.
    private way() {
        const { shown, state } = this.app;
        const nearest = this.place && nearestTo(shown?.loaded.grid.sites ?? [], this.place);
        if (!nearest) return null;
        const { distanceM, azimuth } = nearest.way;
        const degrees = (azimuth * 180) / Math.PI;
        const text = panelTexts.hover.from(distanceText(distanceM, state.units), degrees, nearest.site.icao);
        return { site: nearest.site, distanceM, azimuth, text };
    }

    draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry): void {
        const { place } = this;
        const { shown } = this.app;
        const way = this.way();
        if (!shown || !place || !way) return;
        const plane = planeOf(shown.loaded.grid);
        const pixelOf = (one: Place) => {
            const at = plane.toPlane(one);
            return at && pagePixel(geometry, at, geometry.groundM);
        };
        const ring = Array.from({ length: ringPoints + 1 }, (_, i) =>
            destination(way.site, (2 * Math.PI * i) / ringPoints, way.distanceM),
        );
        for (const [color, width] of [
            [shades.halo, 4],
            [lineColor, 1.5],
        ] as const) {
            pen.strokeStyle = color;
            pen.lineWidth = width * textScale();
            for (const line of [[way.site, place], ring]) {
                pen.beginPath();
                for (const pixel of line.map(pixelOf)) if (pixel) pen.lineTo(...pixel);
                pen.stroke();
            }
        }
        const end = pixelOf(place);
        pen.font = fontOf(12 * textScale(), 'bold');
        if (end) haloed(pen, way.text, end[0] + 8 * textScale(), end[1], shades.text);
    }
}
