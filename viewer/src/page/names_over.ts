// Draws over the picture: the scale of heights, names and marks of tools over each pane, and compass and scale once.

import { ViewGeometry } from '../camera/geometry';
import { Plane } from '../earth/projection';
import { Mark } from '../scene/ground_lines';
import { element, pixelRatio, textScale } from './dom';
import type { Drawing, Overlay } from './drawing';
import { drawHeightScale } from './height_scale';
import { Rect, clearLabels, drawLabels, placeLabels } from './labels';
import type { Pane } from './pane';

const covering = 'header, footer, section, #bar, #legend, #compass, #reset-view, #scale, #sight, .pane-head, .pane-bar';

export class NamesOver {
    readonly overlays: Overlay[] = []; // drawn over each pane
    readonly furniture: Overlay[] = []; // drawn once
    // Returns true if something hides a place on the ground, whose name is then not drawn.
    isHidden: (pane: Pane, geometry: ViewGeometry, at: Plane) => boolean = () => false;
    private canvas = element<HTMLCanvasElement>('labels');
    // Let the browser paint on the processor if there is no graphics processor, because that is faster then.
    readonly pen = this.canvas.getContext('2d', { willReadFrequently: this.drawing.renderer.isSoftware })!;

    constructor(private drawing: Drawing) {}

    draw(): void {
        const { drawing, canvas, pen } = this;
        const { panes, places, picture } = drawing;
        const ratio = pixelRatio();
        const isOne = panes.length === 1;
        const size = (isOne ? drawing.geometry() : null) ?? {
            width: Math.round(picture.clientWidth * ratio),
            height: Math.round(picture.clientHeight * ratio),
        };
        if (canvas.width !== size.width || canvas.height !== size.height)
            [canvas.width, canvas.height] = [size.width, size.height];
        clearLabels(pen);
        const covered = [...document.querySelectorAll(covering)]
            .map((one) => one.getBoundingClientRect())
            .filter((rect) => rect.width > 0);
        const { left, top } = picture.getBoundingClientRect();
        panes.forEach((pane, i) => {
            const place = places[i]!;
            const [x, y] = [place.left / ratio, place.top / ratio];
            pen.save();
            if (!isOne) {
                pen.beginPath();
                pen.rect(x, y, place.width / ratio, place.height / ratio);
                pen.clip();
                pen.translate(x, y);
            }
            this.drawPane(
                pane,
                covered.map((rect) => moved(rect, left + x, top + y)),
            );
            pen.restore();
        });
        const geometry = drawing.geometry();
        if (!geometry) return;
        for (const overlay of this.furniture) {
            pen.save();
            pen.translate(-left, -top);
            overlay(pen, geometry, drawing.pane);
            pen.restore();
        }
    }

    // Draws over a pane. `covered` are rectangles without room, in pixels of the page from the corner of the pane.
    private drawPane(pane: Pane, covered: readonly Rect[]): void {
        const { drawing, pen } = this;
        const geometry = drawing.geometry(1, pane);
        if (!geometry) return;
        const scale = textScale();
        const taken = covered.map(({ left, top, right, bottom }) => ({
            left: left / scale,
            top: top / scale,
            right: right / scale,
            bottom: bottom / scale,
        }));
        const { hasGround, units } = pane.state;
        pen.save();
        pen.scale(scale, scale);
        const grain = pixelRatio() * scale;
        if (hasGround) taken.push(...drawHeightScale(pen, geometry, units, taken, grain));
        // Labels of shapes leave room for the names of sites, and take room from the other names.
        const [sites, others] = [true, false].map((isSite) =>
            hasGround ? drawing.ground.marks.filter(({ kind }) => (kind === 'site') === isSite) : [],
        ) as [Mark[], Mark[]];
        const named = placeLabels(pen, geometry, sites, taken, grain);
        taken.push(...named.map(({ rect }) => rect));
        taken.push(...(drawing.shapes?.draw(pen, geometry, taken, grain) ?? []));
        const isHidden = (at: Plane) => this.isHidden(pane, geometry, at);
        drawLabels(pen, [...named, ...placeLabels(pen, geometry, others, taken, grain, isHidden)]);
        pen.restore();
        for (const overlay of this.overlays) {
            pen.save();
            overlay(pen, geometry, pane);
            pen.restore();
        }
    }
}

const moved = ({ left, top, right, bottom }: Rect, x: number, y: number): Rect => ({
    left: left - x,
    top: top - y,
    right: right - x,
    bottom: bottom - y,
});
