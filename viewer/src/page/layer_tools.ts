// Defines the tools that draw on the ground by dragging: a section, and a box.

import { ViewGeometry } from '../camera/geometry';
import { shades } from '../renderer/shades';
import { legOf } from '../earth/measure';
import { nearestSite } from '../fields/sweep_choice';
import { boxOf } from '../scene/grid_box';
import { Crop, Layers } from '../scene/layers';
import { Place, Plane, planeOf } from '../earth/projection';
import { heightText } from '../tables/units';
import { App } from './app';
import { fontOf, pixelRatio, textScale } from './dom';
import { Drawing } from './drawing';
import { pagePixel } from './labels';
import { Tool } from './pointers';

const reachPixels = 14; // distance within which a press moves an end of the section
const shortestPixels = 6;

// Base of tools with one drag on the ground, which changes the layers and ends the tool.
abstract class GroundTool implements Tool {
    protected fixed: Plane | null = null; // place that stays during the drag

    constructor(
        protected app: App,
        protected drawing: Drawing,
        private done: () => void,
        private ended: () => void,
    ) {}

    abstract press(x: number, y: number): boolean;
    abstract drag(x: number, y: number): void;

    protected groundAt(x: number, y: number): Plane | null {
        return this.drawing.geometry()?.ground(x, y) ?? null;
    }
    protected set(change: Partial<Layers>): void {
        this.app.state.layers = { ...this.app.state.layers, ...change };
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

// Draws a section from the press to the release. A press on an end of the section moves this end.
export class SectionTool extends GroundTool {
    protected takesEndsOnly = false;
    private movesFirst = false;
    private begun: [number, number] = [0, 0];

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
            const pixel = pagePixel(geometry, end, geometry.groundM);
            return pixel && Math.hypot(pixel[0] - x / pixelRatio(), pixel[1] - y / pixelRatio()) < reachPixels;
        });
        if (this.takesEndsOnly && !(held !== undefined && held >= 0)) return false;
        this.movesFirst = held === 0;
        this.fixed = ends && held !== undefined && held >= 0 ? ends[1 - held]! : at;
        return true;
    }
    drag(x: number, y: number): void {
        const at = this.groundAt(x, y);
        if (!at || !this.fixed || !this.app.shown) return;
        if (Math.hypot(x - this.begun[0], y - this.begun[1]) < shortestPixels) return;
        const plane = planeOf(this.app.shown.loaded.grid);
        const [fixed, moved] = [plane.toPlace(this.fixed), plane.toPlace(at)];
        this.set({ section: this.movesFirst ? [moved, fixed] : [fixed, moved] });
    }
}

// Moves an end of the section that is pressed. Leaves other presses to the camera.
export class SectionGrip extends SectionTool {
    protected override takesEndsOnly = true;

    constructor(app: App, drawing: Drawing) {
        super(
            app,
            drawing,
            () => undefined,
            () => undefined,
        );
    }
}

// Draws the sides of a box, from one corner on the ground to the opposite corner.
export class CropTool extends GroundTool {
    press(x: number, y: number): boolean {
        this.fixed = this.groundAt(x, y);
        return this.fixed !== null;
    }
    drag(x: number, y: number): void {
        const [a, b] = [this.fixed, this.groundAt(x, y)];
        const before = this.app.state.layers.crop ?? wholeBox(this.app);
        if (!a || !b || !before || a[0] === b[0] || a[1] === b[1]) return;
        this.set({
            crop: {
                ...before,
                westM: Math.min(a[0], b[0]),
                eastM: Math.max(a[0], b[0]),
                southM: Math.min(a[1], b[1]),
                northM: Math.max(a[1], b[1]),
            },
        });
    }
}

// Returns the box of the shown grid; null if no grid is shown.
export function wholeBox({ shown }: Pick<App, 'shown'>): Crop | null {
    if (!shown) return null;
    const { halfXM, halfYM, bottomM, topM } = boxOf(shown.loaded.grid);
    return { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
}

// Returns a section across the picture, through its middle.
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

// Returns a section from the nearest radar to the farther end of a section, like an RHI; null without radars.
export function fromRadar({ shown }: App, section: readonly [Place, Place]): [Place, Place] | null {
    if (!shown) return null;
    const { grid } = shown.loaded;
    const plane = planeOf(grid);
    const ends = section.map((place) => plane.toPlane(place));
    const site = nearestSite(grid.sites, plane, ends[0] ?? [0, 0]);
    if (!site) return null;
    const [a, b] = section.map((place) => legOf(site, place).distanceM) as [number, number];
    return [{ latitudeDeg: site.latitudeDeg, longitudeDeg: site.longitudeDeg }, a > b ? section[0] : section[1]];
}

// Draws a grip that can be dragged.
function grip(pen: CanvasRenderingContext2D, [x, y]: [number, number]): void {
    for (const [color, width] of [
        [shades.halo, 4],
        [shades.text, 1.5],
    ] as const) {
        pen.beginPath();
        pen.arc(x, y, 11 * textScale(), 0, 2 * Math.PI);
        pen.strokeStyle = color;
        pen.lineWidth = width;
        pen.stroke();
    }
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

// Writes the height of a plane beside its leftmost corner in the picture.
function putHeight(pen: CanvasRenderingContext2D, geometry: ViewGeometry, heightM: number, text: string): void {
    const { halfXM, halfYM } = geometry.box;
    const [right, bottom] = [geometry.width / pixelRatio(), geometry.height / pixelRatio()];
    const corners = [-1, 1].flatMap((x) => [-1, 1].map((y) => pagePixel(geometry, [x * halfXM, y * halfYM], heightM)));
    const seen = corners.filter(
        (one): one is [number, number] => one !== null && one[0] > 0 && one[1] > 0 && one[0] < right && one[1] < bottom,
    );
    const leftmost = seen.sort((a, b) => a[0] - b[0])[0];
    if (leftmost) letter(pen, text, [Math.max(30, leftmost[0]), leftmost[1] + 16]);
}

// Draws the line of the section on the ground with its ends A and B, the box of the crop, and the plane's height.
export function addMarks(drawing: Drawing): void {
    drawing.addOverlay((pen, geometry, { shown, state }) => {
        const { section, crop, planeM } = state.layers;
        if (!shown || (!section && !crop && planeM === null)) return;
        const toPixel = (at: Plane, heightM = geometry.groundM) => pagePixel(geometry, at, heightM);
        const line = (points: ([number, number] | null)[]) => {
            pen.beginPath();
            for (const point of points) if (point) pen.lineTo(...point);
            pen.stroke();
        };
        pen.strokeStyle = shades.quietText;
        pen.lineWidth = 1.2;
        if (planeM !== null) putHeight(pen, geometry, planeM, heightText(planeM, state.units));
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
            const [from = null, to = null] = section.map((place) => {
                const at = plane.toPlane(place);
                return at && toPixel(at);
            });
            pen.setLineDash([6, 4]);
            line([from, to]);
            pen.setLineDash([]);
            for (const [name, end] of [
                ['A', from],
                ['B', to],
            ] as const) {
                if (!end) continue;
                grip(pen, end);
                letter(pen, name, end);
            }
        }
    });
}
