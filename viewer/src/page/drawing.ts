// Draws the picture: the scene, and over it names and the marks of tools. Draws the scene faster and less exactly while
// the view moves.

import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { Governor } from '../renderer/governor';
import { Rung, rungs, usualRungs } from '../renderer/ladder';
import { DrawnLayers } from '../renderer/layer_passes';
import { Frame } from '../renderer/frame';
import { Renderer } from '../renderer/renderer';
import { shownUnit } from '../tables/units';
import { boxOf } from '../scene/grid_box';
import { Mark } from '../scene/ground_lines';
import { isVelocity } from '../wire/moments';
import { App, Shown } from './app';
import { ColorBar } from './color_bar';
import { element, pixelRatio, textScale } from './dom';
import { Ground } from './ground';
import { drawHeightScale } from './height_scale';
import { LayerMaker } from './layer_maker';
import { Rect, clearLabels, drawLabels, placeLabels } from './labels';
import { addSkeleton } from './skeleton';
import { Streaming } from './streaming';
import { texts } from './texts';
import { Windows } from './windows';

const movingFrameMs = 50;
const mostMovingDE = 20;
const leastStillAfterMs = 180;
const mostStillAfterMs = 1000;
const leastBetweenMs = 150; // between pictures while bricks come
const longestWishMs = 30_000;

// Velocities of these moments are away from the radar at one end of the bar of colors, and toward it at the other.
const endsOf = (moment: string) => (isVelocity(moment) ? texts.velocityEnds : null);

// Draws over the picture in pixels of the page.
export type Overlay = (pen: CanvasRenderingContext2D, geometry: ViewGeometry) => void;

// Draws shapes on the ground, below the names of the map, and returns the rectangles of its own labels. `taken` are
// rectangles without room for labels. A pixel of the pen is `ratio` pixels of the picture wide.
export interface GroundShapes {
    isOn: boolean; // an overlay is on
    isWaiting: boolean; // not all shapes of the picture have come
    draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry, taken: readonly Rect[], ratio: number): Rect[];
}

export class Drawing {
    readonly labels = element<HTMLCanvasElement>('labels');
    // Let the browser paint on the processor if there is no graphics processor, because that is faster then.
    private pen = this.labels.getContext('2d', { willReadFrequently: this.renderer.isSoftware })!;
    private bar = new ColorBar(element<HTMLCanvasElement>('bar'));
    private overlays: Overlay[] = [];
    shapes: GroundShapes | null = null; // null until the program of overlays has come
    isLoadingLayers = false; // the program of a layer has not come (panels/load_layers.ts)
    drawn: DrawnLayers | null = null; // layers of the last picture
    readonly pictureChanged: (() => void)[] = []; // called after each picture
    readonly pictureFinished: (() => void)[] = []; // called after each complete picture
    private ground = new Ground(this.app, this.renderer, () => this.draw());
    private streaming = new Streaming(
        this.renderer,
        this.app.loader.decoder,
        this.app.loader.budget.mostCells,
        () => this.drawLater(),
        (error) => this.app.fail(error),
    );
    readonly windows = new Windows(
        this.app.loader.decoder,
        this.app.loader.budget.bytes,
        () => this.app.cellsCame(),
        (error) => this.app.fail(error),
    );
    readonly layers = new LayerMaker(this.app, this.windows, () => this.app.cellsCame());
    private lookedAt = ''; // view for which bricks were last asked
    private governor = new Governor(usualRungs, movingFrameMs, mostMovingDE);
    private movedAt = 0;
    private wasPlaying = false;
    private isDrawing = false;
    private isWaiting = false; // a later picture is due, because bricks have come
    private lastMs = 0; // duration of the last frame
    private frames = 0;
    private isFinal = false;
    private wish: { act: () => void } | null = null; // action that waits for a fine picture

    constructor(
        private app: App,
        readonly renderer: Renderer,
        readonly picture: HTMLCanvasElement,
    ) {
        renderer.prepare();
        app.loader.onPlace = (domain, place) => void this.ground.expect(domain, place);
        addSkeleton(app, this.labels, this.pen, (domain, place) => this.ground.expect(domain, place));
        app.loader.besides = () => this.windows.bytes;
        app.alongside = (next, isAhead) => this.layers.alongside(next, isAhead, this.geometryOf(next.loaded, 1));
        app.isShownWhole = () => !this.layers.isWaiting;
        app.repeats = () => this.layers.repeats();
        app.on('cells', () => this.draw());
        app.on('shown', () => this.show());
        app.on('units', () => {
            if (app.shown) void this.ground.show(app.shown);
        });
        app.on('choices', () => this.layers.askAgain());
        app.on('view', () => this.draw());
        app.on('time', () => this.drawAtRest());
        app.on('camera', () => this.move());
        app.on('restored', () => {
            renderer.forget();
            this.ground.forget();
        });
        picture.addEventListener('webglcontextlost', () => app.takeGraphics(false));
        picture.addEventListener('webglcontextrestored', () => {
            app.takeGraphics(true);
            app.showing.restore();
        });
        window.addEventListener('resize', () => this.draw());
    }

    private show(): void {
        const { shown } = this.app;
        if (!shown) return;
        this.renderer.show(shown.loaded);
        this.streaming.show(shown.loaded);
        this.lookedAt = '';
        void this.ground.show(shown);
    }

    addOverlay(overlay: Overlay): void {
        this.overlays.push(overlay);
    }

    get cities(): Mark[] {
        return this.ground.marks.filter(({ kind }) => kind === 'city');
    }

    // Returns the camera of the picture; null while nothing is shown. A pixel of the picture is `grain` pixels of the
    // screen wide.
    geometry(grain = 1): ViewGeometry | null {
        const shown = this.app.shown;
        return shown ? this.geometryOf(shown.loaded, grain) : null;
    }
    private geometryOf({ grid }: LoadedGrid, grain: number): ViewGeometry {
        const ratio = pixelRatio();
        const width = Math.max(16, Math.round((this.picture.clientWidth * ratio) / grain));
        const height = Math.max(16, Math.round((this.picture.clientHeight * ratio) / grain));
        const { camera, exaggeration } = this.app.state;
        return new ViewGeometry(boxOf(grid), camera, exaggeration, width, height);
    }

    // Call while the view moves. Draws fast pictures, and a fine picture once the view rests.
    move(): void {
        this.movedAt = performance.now();
        this.draw();
    }

    draw(): void {
        this.isFinal = false;
        delete document.documentElement.dataset['drawn'];
        if (this.isDrawing) return;
        this.isDrawing = true;
        requestAnimationFrame(() => this.drawNow());
    }

    // Draws a fine picture when playback stops, because playback draws fast pictures.
    private drawAtRest(): void {
        const { isPlaying } = this.app.player;
        if (this.wasPlaying && !isPlaying) this.draw();
        this.wasPlaying = isPlaying;
    }

    // Returns how long the view must rest before a fine picture. The time is longer if frames take long.
    private get stillAfterMs(): number {
        return Math.min(mostStillAfterMs, Math.max(leastStillAfterMs, 2 * this.lastMs));
    }

    // Draws after a pause, because bricks come faster than pictures can be drawn.
    private drawLater(): void {
        if (this.isWaiting) return;
        this.isWaiting = true;
        window.setTimeout(
            () => {
                this.isWaiting = false;
                this.draw();
            },
            Math.max(leastBetweenMs, this.lastMs),
        );
    }

    private rung({ stream }: LoadedGrid, isMoving: boolean): Rung {
        const allowed = stream ? rungs : usualRungs;
        return allowed.find(({ name }) => name === this.app.state.quality) ?? this.governor.next(isMoving);
    }

    // Asks for bricks if the view has changed since bricks were last asked for.
    private stream(geometry: ViewGeometry, { halvings }: Rung): void {
        const { camera, exaggeration } = this.app.state;
        const view = JSON.stringify([camera, exaggeration, geometry.width, geometry.height, halvings]);
        if (view !== this.lookedAt) this.streaming.look(geometry, halvings);
        this.lookedAt = view;
    }

    // Calls `act` when the next fine picture is complete and on the canvas. If this takes longer than longestWishMs,
    // calls `giveUp` instead. A later call replaces a call that still waits; neither function of the replaced call is
    // called then.
    whenFine(act: () => void, giveUp: () => void): void {
        const wish = (this.wish = { act });
        window.setTimeout(() => {
            if (this.wish !== wish) return;
            this.wish = null;
            giveUp();
        }, longestWishMs);
        this.draw();
    }

    // Returns true if the picture has all layers, the ground, and the chosen domain and moment. A grid in parts may
    // still lack detail.
    private get isComplete(): boolean {
        const { shown, state } = this.app;
        return (
            !this.layers.isWaiting &&
            !this.isLoadingLayers &&
            !this.ground.isWaiting &&
            !this.shapes?.isWaiting &&
            shown?.moment === state.moment &&
            shown.domain === state.domain &&
            !this.renderer.isLost
        );
    }

    private drawNow(): void {
        this.isDrawing = false;
        const { app } = this;
        const { shownTable: table, shown, state } = app;
        if (!table || !shown) return;
        const geometry = this.geometryOf(shown.loaded, 1);
        const isMoving = !this.wish && performance.now() - this.movedAt < this.stillAfterMs;
        const rung = this.rung(shown.loaded, isMoving || (app.player.isPlaying && !this.wish));
        this.stream(geometry, rung);
        const frame: Frame = {
            geometry: rung.grain > 1 ? this.geometryOf(shown.loaded, rung.grain) : geometry,
            ...rung,
            opacity: state.opacity,
            table,
            leastValue: state.least ?? -1e9,
            hasVolume: state.layers.hasVolume,
            hasGround: state.hasGround,
            layers: (this.drawn = this.layers.make(geometry, isMoving)),
            keepsExposure: isMoving,
        };
        const fetches = state.countsFetches && !isMoving ? this.renderer.fetchesAPixel(frame) / rung.grain ** 2 : null;
        const begun = performance.now();
        this.renderer.draw(frame);
        this.renderer.finish();
        const ms = Math.round(performance.now() - begun);
        this.governor.took(rung, ms);
        this.lastMs = ms;
        this.drawOver(geometry);
        this.bar.show(table, shownUnit(table.unit, state.units), state.least, endsOf(shown.moment));
        this.tell({ frameMs: ms, rung: rung.name, frames: ++this.frames });
        for (const act of this.pictureChanged) act();
        if (isMoving) window.setTimeout(() => this.draw(), this.stillAfterMs);
        else if (!this.isFinal && this.isComplete) this.end(shown, rung, ms, fetches);
    }

    // Reports how the complete picture was drawn. If no bricks are missing, carries out the action in `wish`.
    private end(shown: Shown, rung: Rung, ms: number, fetches: number | null): void {
        const { app } = this;
        this.isFinal = true;
        const { detail } = this.streaming;
        const ofLayers = this.windows.coarsest(shown.loaded);
        const said = [
            detail && texts.detail(detail),
            ofLayers !== (detail?.coarsest ?? 0) && texts.detailOfLayers(ofLayers),
        ];
        app.say(said.filter(Boolean).join(' · '), false);
        element('drawn-how').textContent = texts.drawn(ms, rung, fetches);
        const held = texts.held(app.loader.bytes, app.loader.budget.bytes);
        element('held').textContent = held;
        this.tell({ fetches, missing: detail?.missing ?? 0, held });
        document.documentElement.dataset['drawn'] = shown.key;
        document.documentElement.dataset['variants'] = this.renderer.compiledVariants.join('; ');
        for (const act of this.pictureFinished) act();
        if (!this.wish || (detail?.missing ?? 0) > 0) return;
        const { act } = this.wish;
        this.wish = null;
        act();
    }

    // Draws names and marks again, but not the scene.
    drawMarks(): void {
        const geometry = this.geometry();
        if (geometry && !this.isDrawing) this.drawOver(geometry);
    }

    private drawOver(geometry: ViewGeometry): void {
        if (this.labels.width !== geometry.width || this.labels.height !== geometry.height) {
            this.labels.width = geometry.width;
            this.labels.height = geometry.height;
        }
        const scale = textScale();
        const taken = [
            ...document.querySelectorAll(
                'header, footer, section, #bar, #legend, #compass, #reset-view, #scale, #sight',
            ),
        ]
            .map((one) => one.getBoundingClientRect())
            .filter((rect) => rect.width > 0)
            .map(({ left, top, right, bottom }) => ({
                left: left / scale,
                top: top / scale,
                right: right / scale,
                bottom: bottom / scale,
            }));
        const { pen } = this;
        const ratio = pixelRatio();
        clearLabels(pen);
        const { hasGround, units } = this.app.state;
        pen.save();
        pen.scale(scale, scale);
        const grain = ratio * scale;
        if (hasGround) taken.push(...drawHeightScale(pen, geometry, units, taken, grain));
        // Labels of shapes leave room for the names of sites, and take it from the other names.
        const [sites, others] = [true, false].map((isSite) =>
            hasGround ? this.ground.marks.filter(({ kind }) => (kind === 'site') === isSite) : [],
        ) as [Mark[], Mark[]];
        const named = placeLabels(pen, geometry, sites, taken, grain);
        taken.push(...named.map(({ rect }) => rect));
        taken.push(...(this.shapes?.draw(pen, geometry, taken, grain) ?? []));
        drawLabels(pen, [...named, ...placeLabels(pen, geometry, others, taken, grain)]);
        pen.restore();
        for (const overlay of this.overlays) {
            pen.save();
            overlay(pen, geometry);
            pen.restore();
        }
    }

    // Publishes figures for programs that drive the page.
    private tell(figures: Record<string, string | number | null>): void {
        for (const [name, figure] of Object.entries(figures)) document.documentElement.dataset[name] = String(figure);
    }
}
