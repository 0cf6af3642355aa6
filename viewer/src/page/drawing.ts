// Draws the picture: the scene, and over it names and the marks of tools. Draws the scene faster and less exactly while
// the view moves.

import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { Governor } from '../renderer/governor';
import { Rung, rungs, usualRungs } from '../renderer/ladder';
import { DrawnLayers } from '../renderer/layer_passes';
import { Frame } from '../renderer/frame';
import { Picture, drawParts } from '../renderer/picture';
import { Renderer } from '../renderer/renderer';
import { shownUnit } from '../tables/units';
import { boxOf } from '../scene/grid_box';
import { Mark } from '../scene/ground_lines';
import { PanePlace, panePlaces } from '../scene/pane_places';
import { PaneCount, allPanes } from '../scene/panes';
import { App, Shown } from './app';
import { ColorBar, endsOf } from './color_bar';
import { afterPictureMs, element, pixelRatio } from './dom';
import { Ground } from './ground';
import { LayerMaker, LayerShare } from './layer_maker';
import { Rect } from './labels';
import { NamesOver } from './names_over';
import { Pane } from './pane';
import { addSkeleton } from './skeleton';
import { Streaming } from './streaming';
import { SweepStore } from './sweep_store';
import { texts } from './texts';
import { Turns } from './turns';
import { Windows } from './windows';

const movingFrameMs = 50;
const mostMovingDE = 20;
const stillAfterMs = 180; // how long the view must rest before a fine picture
const mostWholeMs = 60; // a picture that takes longer is drawn in parts
const leastBetweenMs = 150; // between pictures while bricks come
const longestWishMs = 30_000;
const sweepsOfBudget = 0.2; // share of the page's memory for sweeps
const gapPixels = 2; // between panes

// Draws over a pane of the picture in pixels of the page.
export type Overlay = (pen: CanvasRenderingContext2D, geometry: ViewGeometry, pane: Pane) => void;

// Draws shapes on the ground, below the names of the map, and returns the rectangles of its own labels. `taken` are
// rectangles without room for labels. A pixel of the pen is `ratio` pixels of the picture wide.
export interface GroundShapes {
    isOn: boolean; // an overlay is on
    isWaiting: boolean; // not all shapes of the picture have come
    draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry, taken: readonly Rect[], ratio: number): Rect[];
}

export class Drawing {
    readonly labels = element<HTMLCanvasElement>('labels');
    private names = new NamesOver(this);
    private bar = new ColorBar(element<HTMLCanvasElement>('bar'));
    shapes: GroundShapes | null = null; // null until the program of overlays has come
    isLoadingLayers = false; // the program of a layer has not come (panels/load_layers.ts)
    readonly pictureChanged: (() => void)[] = []; // called after each picture
    readonly pictureFinished: (() => void)[] = []; // called after each complete picture
    readonly ground = new Ground(this.app, this.renderer, () => this.draw());
    private streaming = new Streaming(
        this.renderer,
        this.app.loader.decoder,
        () => this.app.loader.budget.mostCells,
        () => this.drawLater(),
        (error) => this.app.fail(error),
    );
    readonly share: LayerShare = {
        store: new SweepStore(sweepsOfBudget * this.app.loader.budget.bytes),
        makeRotation: null,
        layerCame: [],
    };
    panes: readonly Pane[] = [new Pane(this.app, 0, this.share)];
    pointed = 0; // index of the pane under the pointer
    private lookedAt = ''; // view for which bricks were last asked
    private governor = new Governor(usualRungs, movingFrameMs, mostMovingDE);
    private movedAt = 0;
    private wasPlaying = false;
    private turns = new Turns(() => this.drawNow());
    private isWaiting = false; // a later picture is due, because bricks have come
    private restTimer = 0; // draws a fine picture after the view has moved
    private lastMs = 0; // duration of the last frame
    private frames = 0;
    private wish: { act: () => void } | null = null; // action that waits for a fine picture

    constructor(
        readonly app: App,
        readonly renderer: Renderer,
        readonly picture: HTMLCanvasElement,
    ) {
        renderer.prepare();
        this.pictureFinished.push(() => window.setTimeout(() => void this.ground.complete(), afterPictureMs));
        app.loader.onPlace = (domain, place) => void this.ground.expect(domain, place);
        addSkeleton(app, this.labels, this.names.pen, (domain, place) => this.ground.expect(domain, place));
        app.loader.besides = () => this.panes.reduce((sum, { windows }) => sum + windows.bytes, 0);
        app.alongside = (next, isAhead) => this.alongside(next, isAhead);
        app.beside = (next) => this.others.map((pane) => pane.beside(next));
        app.isDrawing = () => this.turns.isBusy;
        app.isShownWhole = () => this.panes.every(({ layers }) => !layers.isWaiting);
        app.repeats = (pane = app.state.active) => this.panes[pane]?.layers.repeats() ?? null;
        app.on('cells', () => this.draw());
        app.on('shown', () => {
            this.giveUp();
            this.turns.replace(() => this.show());
        });
        app.on('units', () => {
            if (app.shown) void this.ground.show(app.shown);
        });
        app.on('choices', () => {
            for (const { layers } of this.panes) layers.askAgain();
        });
        app.on('view', () => this.change());
        app.on('time', () => this.drawAtRest());
        app.on('camera', () => this.move());
        app.on('restored', () => {
            this.turns.isStopped = true;
            renderer.forget();
            this.streaming.forget();
            this.ground.forget();
        });
        picture.addEventListener('webglcontextlost', () => app.takeGraphics(false));
        picture.addEventListener('webglcontextrestored', () => {
            app.takeGraphics(true);
            app.showing.restore();
        });
        window.addEventListener('resize', () => this.change());
        // The picture of several panes leaves room for the head of the page.
        new ResizeObserver(() => this.panes.length > 1 && this.draw()).observe(picture);
    }

    // Returns the active pane.
    get pane(): Pane {
        this.takePanes();
        return this.panes[this.app.state.active] ?? this.panes[0]!;
    }
    private get others(): Pane[] {
        this.takePanes();
        return this.panes.filter(({ isActive }) => !isActive);
    }
    get layers(): LayerMaker {
        return this.pane.layers;
    }
    get windows(): Windows {
        return this.pane.windows;
    }
    // Returns the layers of the active pane in the last picture.
    get drawn(): DrawnLayers | null {
        return this.pane.drawn;
    }

    // Makes a pane the active one, unless it shows nothing.
    activate(index: number): void {
        const { app, pane } = this;
        const shown = this.panes[index]?.shown;
        if (!shown || index === pane.index) return;
        pane.keep(app.shown);
        app.shown = shown;
        app.usePanes(allPanes(app.state), index);
    }

    // Adds or drops panes, so that there are as many as in the view.
    private takePanes(): void {
        const count = Math.max(1, this.app.state.panes.length);
        if (this.panes.length === count) return;
        this.app.loader.divide(count);
        document.body.classList.toggle('paned', count > 1);
        this.panes = Array.from({ length: count }, (_, i) => this.panes[i] ?? new Pane(this.app, i, this.share));
    }

    private alongside(next: Shown, isAhead: boolean): Promise<void> | null {
        const geometryOf = (loaded: LoadedGrid) => this.geometryOf(loaded, 1);
        const waits = [
            this.layers.alongside(next, isAhead, geometryOf(next.loaded)),
            ...this.others.map((pane) => pane.alongside(next, isAhead, geometryOf)),
        ].filter((one): one is Promise<void> => one !== null);
        return waits.length > 0 ? Promise.all(waits).then(() => undefined) : null;
    }

    private show(): void {
        const { shown } = this.app;
        if (!shown) return;
        for (const pane of this.others) pane.keep(pane.beside(shown));
        const all = [...new Set(this.panes.flatMap((pane) => pane.shown?.loaded ?? []))];
        this.renderer.show(all);
        this.streaming.show(all);
        this.lookedAt = '';
        void this.ground.show(shown);
    }

    // Draws no names of places for which `isHidden` returns true.
    hideNames(isHidden: NamesOver['isHidden']): void {
        this.names.isHidden = isHidden;
    }
    // Adds marks that are drawn over each pane.
    addOverlay(overlay: Overlay): void {
        this.names.overlays.push(overlay);
    }
    // Adds marks that are drawn once over all panes.
    addFurniture(overlay: Overlay): void {
        this.names.furniture.push(overlay);
    }

    get cities(): Mark[] {
        return this.ground.marks.filter(({ kind }) => kind === 'city');
    }

    // Returns the places of the panes in pixels of the picture.
    get places(): PanePlace[] {
        this.takePanes();
        const ratio = pixelRatio();
        const [width, height] = [this.picture.clientWidth * ratio, this.picture.clientHeight * ratio];
        const count = this.panes.length as PaneCount;
        if (count === 1) return [{ left: 0, top: 0, width, height }];
        return panePlaces(count, Math.round(width), Math.round(height), Math.round(gapPixels * ratio));
    }

    // Returns the camera of a pane, usually of the active one; null while it shows nothing. A pixel of the pane is
    // `grain` pixels of the screen wide.
    geometry(grain = 1, pane = this.pane): ViewGeometry | null {
        return pane.shown ? this.geometryOf(pane.shown.loaded, grain) : null;
    }
    private geometryOf({ grid }: LoadedGrid, grain: number): ViewGeometry {
        const place = this.places[0]!;
        const width = Math.max(16, Math.round(place.width / grain));
        const height = Math.max(16, Math.round(place.height / grain));
        const { camera, exaggeration } = this.app.state;
        return new ViewGeometry(boxOf(grid), camera, exaggeration, width, height);
    }

    // Call while the view moves. Draws fast pictures, and a fine picture once the view rests.
    move(): void {
        this.movedAt = performance.now();
        this.turns.stop();
        this.draw();
    }

    // Gives up a fine picture. A fast one then follows, so that a busy page shows pictures, too.
    private giveUp(): void {
        if (this.turns.stop()) this.movedAt = performance.now();
    }
    private change(): void {
        this.giveUp();
        this.draw();
    }

    draw(): void {
        delete document.documentElement.dataset['drawn'];
        this.turns.ask();
    }

    // Draws a fine picture when playback stops, because playback draws fast pictures.
    private drawAtRest(): void {
        const { isPlaying } = this.app.player;
        if (this.wasPlaying && !isPlaying) this.draw();
        this.wasPlaying = isPlaying;
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
    private stream({ halvings }: Rung): void {
        const { camera, exaggeration } = this.app.state;
        const { width, height } = this.places[0]!;
        const view = JSON.stringify([camera, exaggeration, width, height, halvings]);
        if (view !== this.lookedAt)
            for (const { shown } of this.panes)
                if (shown) this.streaming.look(shown.loaded, this.geometryOf(shown.loaded, 1), halvings);
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

    // Returns true if the picture has all layers, the ground, and the chosen domain and moments. A grid in parts may
    // still lack detail.
    private get isComplete(): boolean {
        return (
            this.panes.every(({ isComplete }) => isComplete) &&
            !this.isLoadingLayers &&
            !this.ground.isWaiting &&
            !this.shapes?.isWaiting &&
            !this.renderer.isLost
        );
    }

    private frameOf(pane: Pane, rung: Rung, isMoving: boolean): Frame | null {
        const { shown, shownTable: table, state } = pane;
        if (!shown || !table) return null;
        return {
            loaded: shown.loaded,
            geometry: this.geometryOf(shown.loaded, rung.grain),
            ...rung,
            opacity: state.opacity,
            table,
            leastValue: state.least ?? -1e9,
            hasVolume: state.layers.hasVolume,
            hasGround: state.hasGround,
            layers: (pane.drawn = pane.layers.make(this.geometryOf(shown.loaded, 1), isMoving)),
            keepsExposure: isMoving,
        };
    }

    private pictureOf(frames: readonly (Frame | null)[], first: Frame): Picture {
        const { places } = this;
        const ratio = pixelRatio();
        const side = (pixels: number) => Math.round(pixels * ratio);
        const all = { width: side(this.picture.clientWidth), height: side(this.picture.clientHeight) };
        const { width, height } = frames.length === 1 ? first.geometry : all;
        const whole = { left: 0, top: 0, width, height };
        const placeOf = (index: number) => (frames.length === 1 ? whole : places[index]!);
        return { width, height, panes: frames.map((frame, i) => ({ frame, place: placeOf(i) })) };
    }

    private async drawNow(): Promise<void> {
        const { app, pane, renderer } = this;
        const { shownTable: table, shown, state } = app;
        if (!table || !shown) return;
        const isMoving = !this.wish && performance.now() - this.movedAt < stillAfterMs;
        const isFast = isMoving || (app.player.isPlaying && !this.wish);
        this.turns.isFine = !isFast;
        window.clearTimeout(this.restTimer);
        const rung = this.rung(shown.loaded, isFast);
        this.stream(rung);
        const frames = this.panes.map((one) => this.frameOf(one, rung, isMoving));
        const frame = frames[pane.index];
        if (!frame) return;
        const countsFetches = state.countsFetches && !isMoving && frames.length === 1;
        const fetches = countsFetches ? renderer.fetchesAPixel(frame) / rung.grain ** 2 : null;
        const begun = performance.now();
        const predictedMs = this.governor.predictedMs(rung) ?? (renderer.isSoftware ? Infinity : 0);
        const parts = renderer.draw(this.pictureOf(frames, frame), predictedMs <= mostWholeMs);
        const drawn = () => renderer.drawn();
        if (!(await drawParts(parts, drawn, () => this.turns.isStopped))) return;
        this.names.draw();
        this.bar.show(table, shownUnit(table.unit, state.units), state.least, endsOf(shown.moment));
        await drawn();
        const ms = Math.round(performance.now() - begun);
        this.governor.took(rung, ms);
        this.lastMs = ms;
        this.tell({ frameMs: ms, rung: rung.name, frames: ++this.frames });
        for (const act of this.pictureChanged) act();
        if (isMoving) this.restTimer = window.setTimeout(() => this.draw(), stillAfterMs);
        else if (!this.turns.isOutdated && this.isComplete) this.end(shown, rung, ms, fetches);
    }

    // Reports how the complete picture was drawn. If no bricks are missing, carries out the action in `wish`.
    private end(shown: Shown, rung: Rung, ms: number, fetches: number | null): void {
        const { app } = this;
        const detail = this.streaming.detail(shown.loaded);
        const { missing } = this.streaming;
        const ofLayers = this.windows.coarsest(shown.loaded);
        const said = [
            detail && texts.detail(detail),
            ofLayers !== (detail?.coarsest ?? 0) && texts.detailOfLayers(ofLayers),
        ];
        app.say(said.filter(Boolean).join(' · '), false);
        element('drawn-how').textContent = texts.drawn(ms, rung, fetches);
        const held = texts.held(app.loader.bytes, app.loader.budget.bytes);
        element('held').textContent = held;
        this.tell({ fetches, missing, held });
        document.documentElement.dataset['drawn'] = shown.key;
        document.documentElement.dataset['variants'] = this.renderer.compiledVariants.join('; ');
        for (const act of this.pictureFinished) act();
        if (!this.wish || missing > 0) return;
        const { act } = this.wish;
        this.wish = null;
        act();
    }

    // Draws names and marks again, but not the scene.
    drawMarks(): void {
        if (this.app.shown && !this.turns.isAsked) this.names.draw();
    }

    // Publishes figures for programs that drive the page.
    private tell(figures: Record<string, string | number | null>): void {
        for (const [name, figure] of Object.entries(figures)) document.documentElement.dataset[name] = String(figure);
    }
}
