// Tools for drawing on the ground by dragging: a section, and the sides of a box.

import { ViewGeometry } from '../camera/geometry';
import { shades } from '../renderer/shades';
import { boxOf } from '../scene/grid_box';
import { Crop } from '../scene/layers';
import { Place, Plane, planeOf } from '../earth/projection';
import { heightText } from '../tables/units';
import { App } from './app';
import { fontOf, textScale } from './dom';
import { Drawing } from './drawing';
import { Tool } from './pointers';

const reachPixels = 14; // of an end of the section
const shortestPixels = 6;

// A section: press, drag, release. A press on one of its ends moves that end.
export class SectionTool implements Tool {
    private fixed: Plane | null = null; // the end that stays
    private movesFirst = false;
    private begun: [number, number] = [0, 0];

    constructor(
        private app: App,
        private drawing: Drawing,
        private done: () => void,
        private ended: () => void,
    ) {}

    private ends(): [Plane, Plane] | null {
        const { shown, state } = this.app;
        if (!shown || !state.layers.section) return null;
        const plane = planeOf(shown.loaded.grid);
        const [a, b] = state.layers.section.map((place) => plane.toPlane(place));
        return a && b ? [a, b] : null;
    }

    press(x: number, y: number): boolean {
        const geometry = this.drawing.geometry();
        const at = geometry?.ground(x, y);
        if (!geometry || !at) return false;
        this.begun = [x, y];
        const ends = this.ends();
        const held = ends?.findIndex((end) => {
            const pixel = geometry.project([end[0], end[1], geometry.groundM * geometry.exaggeration]);
            return (
                pixel !== null && Math.hypot(pixel[0] - x, pixel[1] - y) < reachPixels * (window.devicePixelRatio || 1)
            );
        });
        this.movesFirst = held === 0;
        this.fixed = ends && held !== undefined && held >= 0 ? ends[1 - held]! : at;
        return true;
    }
    drag(x: number, y: number): void {
        const at = this.drawing.geometry()?.ground(x, y);
        if (!at || !this.fixed || !this.app.shown) return;
        if (Math.hypot(x - this.begun[0], y - this.begun[1]) < shortestPixels) return;
        const plane = planeOf(this.app.shown.loaded.grid);
        const places = [plane.toPlace(this.fixed), plane.toPlace(at)] as [Place, Place];
        this.app.state.layers = {
            ...this.app.state.layers,
            section: this.movesFirst ? [places[1], places[0]] : places,
        };
        this.drawing.move();
        this.app.changed();
    }
    release(): void {
        this.fixed = null;
        this.done();
    }
    end(): void {
        this.fixed = null;
        this.ended();
    }
}

// The sides of a box, from one corner on the ground to the other.
export class CropTool implements Tool {
    private corner: Plane | null = null;

    constructor(
        private app: App,
        private drawing: Drawing,
        private done: () => void,
        private ended: () => void,
    ) {}

    press(x: number, y: number): boolean {
        this.corner = this.drawing.geometry()?.ground(x, y) ?? null;
        return this.corner !== null;
    }
    drag(x: number, y: number): void {
        const at = this.drawing.geometry()?.ground(x, y);
        const before = this.app.state.layers.crop ?? wholeBox(this.app);
        if (!at || !this.corner || !before) return;
        const [a, b] = [this.corner, at];
        if (a[0] === b[0] || a[1] === b[1]) return;
        const crop: Crop = {
            ...before,
            westM: Math.min(a[0], b[0]),
            eastM: Math.max(a[0], b[0]),
            southM: Math.min(a[1], b[1]),
            northM: Math.max(a[1], b[1]),
        };
        this.app.state.layers = { ...this.app.state.layers, crop };
        this.drawing.move();
        this.app.changed();
    }
    release(): void {
        this.corner = null;
        this.done();
    }
    end(): void {
        this.corner = null;
        this.ended();
    }
}

// The box of the grid that is shown.
export function wholeBox({ shown }: App): Crop | null {
    if (!shown) return null;
    const { halfXM, halfYM, bottomM, topM } = boxOf(shown.loaded.grid);
    return { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
}

// A section across the picture, through the middle of what is looked at.
export function acrossView(app: App, geometry: ViewGeometry): [Place, Place] | null {
    const middle = geometry.ground(0.5 * geometry.width, 0.5 * geometry.height) ?? [0, 0];
    const half = 0.3 * geometry.width * geometry.metersPerPixel;
    const plane = app.shown && planeOf(app.shown.loaded.grid);
    const at = (side: number): Plane => [
        middle[0] + side * half * geometry.right[0],
        middle[1] + side * half * geometry.right[1],
    ];
    return plane && [plane.toPlace(at(-1)), plane.toPlace(at(1))];
}

function letter(pen: CanvasRenderingContext2D, text: string, [x, y]: [number, number]): void {
    pen.font = fontOf(14 * textScale(), 'bold');
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.lineWidth = 4;
    pen.strokeStyle = shades.halo;
    pen.strokeText(text, x, y);
    pen.fillStyle = shades.text;
    pen.fillText(text, x, y);
}

// The height of a plane, beside its corner that is farthest to the left in the picture.
function putHeight(
    pen: CanvasRenderingContext2D,
    { box, width, height }: ViewGeometry,
    toPixel: (corner: Plane) => [number, number] | null,
    text: string,
    ratio: number,
): void {
    const corners = [-1, 1].flatMap((x) => [-1, 1].map((y) => toPixel([x * box.halfXM, y * box.halfYM])));
    const seen = corners.filter(
        (one): one is [number, number] =>
            one !== null && one[0] > 0 && one[1] > 0 && one[0] < width / ratio && one[1] < height / ratio,
    );
    const leftmost = seen.sort((a, b) => a[0] - b[0])[0];
    if (leftmost) letter(pen, text, [Math.max(30, leftmost[0]), leftmost[1] + 16]);
}

// The line of the section on the ground, with its ends A and B, and the box of the crop.
export function addMarks(app: App, drawing: Drawing): void {
    drawing.addOverlay((pen, geometry) => {
        const { shown } = app;
        const { section, crop, planeM } = app.state.layers;
        if (!shown || (!section && !crop && planeM === null)) return;
        const ratio = window.devicePixelRatio || 1;
        const toPixel = ([x, y]: Plane, heightM = geometry.groundM): [number, number] | null => {
            const pixel = geometry.project([x, y, heightM * geometry.exaggeration]);
            return pixel && [pixel[0] / ratio, pixel[1] / ratio];
        };
        const line = (points: ([number, number] | null)[]) => {
            pen.beginPath();
            for (const point of points) if (point) pen.lineTo(...point);
            pen.stroke();
        };
        pen.strokeStyle = shades.quietText;
        pen.lineWidth = 1.2;
        if (planeM !== null)
            putHeight(pen, geometry, (corner) => toPixel(corner, planeM), heightText(planeM, app.state.units), ratio);
        if (crop) {
            const corners: Plane[] = [
                [crop.westM, crop.southM],
                [crop.eastM, crop.southM],
                [crop.eastM, crop.northM],
                [crop.westM, crop.northM],
            ];
            for (const heightM of [Math.max(crop.bottomM, geometry.groundM), crop.topM])
                line([...corners, corners[0]!].map((corner) => toPixel(corner, heightM)));
            for (const corner of corners) line([toPixel(corner, crop.bottomM), toPixel(corner, crop.topM)]);
        }
        if (section) {
            const plane = planeOf(shown.loaded.grid);
            const [a, b] = section.map((place) => plane.toPlane(place) ?? null);
            const [from, to] = [a && toPixel(a), b && toPixel(b)];
            pen.setLineDash([6, 4]);
            line([from ?? null, to ?? null]);
            if (from) letter(pen, 'A', from);
            if (to) letter(pen, 'B', to);
        }
    });
}
