// Holds the overlays of the page: the server's, which the address names, and files that the user added. Draws those
// that are on.

import { ViewGeometry } from '../../camera/geometry';
import { shapesOfGeojson } from '../../overlay/geojson_shapes';
import { shapesOfText } from '../../overlay/shape_file';
import { Shape, Shapes, mostFileBytes, shapesInForce, shownText } from '../../overlay/shapes';
import { isAbsent, overlayNames, overlayShapes } from '../../wire/api';
import { App } from '../app';
import { Drawing, GroundShapes } from '../drawing';
import { Rect } from '../labels';
import { layerTexts } from '../later_texts';
import { ShapeMarks } from './shape_marks';

const words = layerTexts.overlays;
const againAfterMs = 60_000;
const lookAfterMs = 15_000; // between looks for shapes that have come into force, or are over
const liveMs = 30 * 60 * 1000; // no radar takes so long from one volume to the next

interface FileLayer {
    name: string;
    shapes: Shapes;
    isOn: boolean;
}
interface ServedLayer {
    shapes: Shapes | null; // null: they have not come
    failure: string; // why the last answer did not come; empty: it came
    leftOut: string; // files that the server could not read
    isComing: boolean;
}
// An overlay as the panel shows it.
export interface OverlayRow {
    name: string;
    text: string; // name and number of shapes in force
    isOn: boolean;
    toggle: () => void;
    remove: (() => void) | null; // null: the overlay is the server's
}

export class OverlayLayers implements GroundShapes {
    problem = ''; // why files were not added
    changed: () => void = () => undefined; // called when rows or `problem` may have changed
    private names: string[] = []; // of the server
    private served = new Map<string, ServedLayer>();
    private files: FileLayer[] = [];
    private marks = new ShapeMarks();
    private timer = 0; // 0: all shapes in force are projected
    private drawn: Shape[] = []; // of the last picture

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    begin(): void {
        this.drawing.shapes = this;
        this.app.on(['view', 'shown', 'choices', 'time'], () => this.need());
        window.setInterval(() => this.fetchAgain(), againAfterMs);
        window.setInterval(() => {
            const { shown } = this;
            if (shown.length !== this.drawn.length || shown.some((one, i) => one !== this.drawn[i])) this.update();
        }, lookAfterMs);
        this.need();
    }

    // -- overlays of the server

    // Asks which overlays the server has.
    async askNames(): Promise<void> {
        try {
            this.names = await overlayNames();
        } catch (error) {
            if (isAbsent(error)) this.names = [];
        }
        this.changed();
    }
    private need(): void {
        for (const name of this.app.state.overlays) if (!this.served.has(name)) void this.fetch(name);
        this.changed();
    }
    // While the page is live, fetches the overlays that are on. Otherwise, fetches only what has failed.
    private fetchAgain(): void {
        for (const name of this.app.state.overlays)
            if (this.app.player.follows || this.served.get(name)?.failure) void this.fetch(name);
    }
    private async fetch(name: string): Promise<void> {
        const layer = this.served.get(name) ?? { shapes: null, failure: '', leftOut: '', isComing: false };
        if (layer.isComing) return;
        this.served.set(name, layer);
        layer.isComing = true;
        try {
            const answer = await overlayShapes(name);
            layer.shapes = shapesOfGeojson(answer);
            layer.leftOut = words.leftOut(answer.left_out ?? []);
            layer.failure = '';
        } catch (error) {
            layer.failure = isAbsent(error) ? words.absent : words.failed;
            if (isAbsent(error)) layer.shapes = null;
        }
        layer.isComing = false;
        this.update();
    }
    private toggleServed(name: string): void {
        const { overlays } = this.app.state;
        const isOn = overlays.includes(name);
        this.app.state.overlays = isOn ? overlays.filter((one) => one !== name) : [...overlays, name];
        if (!isOn) void this.fetch(name);
        this.app.changed();
    }

    // -- files

    // Adds files. A file of the same name is replaced. Returns false if a file is damaged or has no shape in force.
    async add(files: readonly File[]): Promise<boolean> {
        const problems: string[] = [];
        let areShown = true;
        for (const file of files) {
            try {
                if (file.size > mostFileBytes) throw new Error(words.tooLarge(mostFileBytes / 2 ** 20));
                const shapes = shapesOfText(await file.text());
                this.files = [
                    ...this.files.filter(({ name }) => name !== file.name),
                    { name: file.name, shapes, isOn: true },
                ];
                areShown &&= shapesInForce(shapes, this.timeMs).length > 0;
            } catch (error) {
                problems.push(words.damaged(file.name, error instanceof Error ? error.message : String(error)));
            }
        }
        this.problem = problems.join(' ');
        this.update();
        return areShown && problems.length === 0;
    }

    // -- the panel, and the picture

    private update(): void {
        this.changed();
        this.drawing.draw();
    }
    // Returns true if shapes are shown that are in force now. A live page shows a warning at once, and not with the
    // next volume.
    private get isNow(): boolean {
        const { player, server, shown } = this.app;
        const ageMs = server.nowMs - (shown?.loaded.grid.timeMs ?? NaN);
        return player.follows && ageMs >= 0 && ageMs < liveMs;
    }
    // Returns the time for which shapes are shown: that of the volume, or the present.
    private get timeMs(): number {
        return this.isNow ? this.app.server.nowMs : (this.app.shown?.loaded.grid.timeMs ?? NaN);
    }
    get rows(): OverlayRow[] {
        const { overlays } = this.app.state;
        const told = (shapes: Shapes) => shownText(shapes, this.timeMs) + (this.isNow ? words.now : '');
        const text = (name: string, shapes: Shapes | null | undefined, problem = '') =>
            words.told(name, shapes && this.app.shown ? told(shapes) : '', problem);
        const served = [...new Set([...this.names, ...overlays])].map((name) => {
            const layer = this.served.get(name);
            const isOn = overlays.includes(name);
            const toggle = () => this.toggleServed(name);
            return {
                name,
                text: text(name, layer?.shapes, isOn ? layer?.failure || layer?.leftOut : ''),
                isOn,
                toggle,
                remove: null,
            };
        });
        const files = this.files.map((file) => ({
            name: file.name,
            text: text(file.name, file.shapes),
            isOn: file.isOn,
            toggle: () => {
                file.isOn = !file.isOn;
                this.update();
            },
            remove: () => {
                this.files = this.files.filter((one) => one !== file);
                this.update();
            },
        }));
        return [...served, ...files];
    }

    get isOn(): boolean {
        return this.app.state.overlays.length > 0 || this.files.some(({ isOn }) => isOn);
    }
    get isWaiting(): boolean {
        const isComing = (name: string) => {
            const layer = this.served.get(name);
            return layer?.isComing === true && !layer.shapes;
        };
        return this.timer !== 0 || this.app.state.overlays.some(isComing);
    }
    private get shown(): Shape[] {
        const layers = [
            ...this.app.state.overlays.map((name) => this.served.get(name)?.shapes),
            ...this.files.map(({ shapes, isOn }) => isOn && shapes),
        ];
        return layers.flatMap((all) => (all ? shapesInForce(all, this.timeMs) : []));
    }
    draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry, taken: readonly Rect[], ratio: number): Rect[] {
        const { shown } = this;
        this.drawn = shown;
        document.documentElement.dataset['shapes'] = String(shown.length);
        if (this.timer === 0) this.project();
        return this.marks.draw(pen, geometry, ratio, taken, shown);
    }
    // Projects the shapes, those of large files in several tasks, so that the page does not freeze.
    private project(): void {
        const grid = this.app.shown?.loaded.grid;
        const wasBehind = this.timer !== 0;
        const isDone = !grid || this.marks.project(this.shown, grid);
        this.timer = isDone ? 0 : window.setTimeout(() => this.project());
        if (isDone && wasBehind) this.drawing.draw();
    }
}
