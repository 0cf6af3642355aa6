// Draws the picture: the scene, and over it the names and what a tool marks. Coarser while it moves.

import { ViewGeometry } from '../camera/geometry';
import { Renderer } from '../renderer/renderer';
import { shownUnit } from '../tables/units';
import { App } from './app';
import { drawColorBar } from './color_bar';
import { element, textScale } from './dom';
import { Ground } from './ground';
import { LayerMaker } from './layer_maker';
import { clearLabels, drawLabels } from './labels';
import { boxOf } from './reading';
import { texts } from './texts';

const stillSlices = 256;
const movingSlices = 128;
const stillAfterMs = 180;

// Draws over the picture in pixels of the page.
export type Overlay = (pen: CanvasRenderingContext2D, geometry: ViewGeometry) => void;

export class Drawing {
    readonly picture = element<HTMLCanvasElement>('picture');
    readonly labels = element<HTMLCanvasElement>('labels');
    readonly renderer = new Renderer(this.picture);
    private overlays: Overlay[] = [];
    layers: LayerMaker | null = null;
    private ground: Ground | null = null;
    private app: App | null = null;
    private movedAt = 0;
    private isDrawing = false;
    private isFinal = false;

    begin(app: App): void {
        this.app = app;
        this.renderer.prepare();
        this.ground = new Ground(app, this.renderer, () => this.draw());
        this.layers = new LayerMaker(app, () => this.draw());
        app.on('shown', () => {
            this.renderer.show(app.shown!.loaded);
            void this.ground!.show(app.shown!);
        });
        app.on('units', () => {
            if (app.shown) void this.ground!.show(app.shown);
        });
        app.on('view', () => this.draw());
        app.on('camera', () => this.move());
        app.on('restored', () => {
            this.renderer.forget();
            this.ground!.forget();
        });
        this.picture.addEventListener('webglcontextrestored', () => app.restore());
        window.addEventListener('resize', () => this.draw());
    }

    addOverlay(overlay: Overlay): void {
        this.overlays.push(overlay);
    }

    geometry(): ViewGeometry | null {
        const shown = this.app?.shown;
        if (!shown) return null;
        const ratio = window.devicePixelRatio || 1;
        const width = Math.max(16, Math.round(this.picture.clientWidth * ratio));
        const height = Math.max(16, Math.round(this.picture.clientHeight * ratio));
        const { camera, exaggeration } = this.app!.state;
        return new ViewGeometry(boxOf(shown.loaded.grid), camera, exaggeration, width, height);
    }

    // Something is being dragged: pictures are drawn fast, and a fine one after it rests.
    move(): void {
        this.movedAt = performance.now();
        this.draw();
    }

    draw(): void {
        this.isFinal = false;
        if (this.isDrawing) return;
        this.isDrawing = true;
        requestAnimationFrame(() => this.drawNow());
    }

    private drawNow(): void {
        this.isDrawing = false;
        const app = this.app!;
        const geometry = this.geometry();
        const { table, shown, state } = app;
        if (!geometry || !table || !shown) return;
        const isMoving = performance.now() - this.movedAt < stillAfterMs;
        const slices = isMoving ? movingSlices : stillSlices;
        const begun = performance.now();
        this.renderer.draw({
            geometry,
            slices,
            opacity: state.opacity,
            table,
            leastValue: state.least ?? -1e9,
            hasVolume: state.layers.hasVolume,
            hasGround: state.hasGround,
            layers: this.layers!.make(),
            keepsExposure: isMoving,
        });
        this.renderer.finish();
        const ms = Math.round(performance.now() - begun);
        this.drawOver(geometry);
        drawColorBar(element<HTMLCanvasElement>('bar'), table, shownUnit(table.unit, state.units), state.least);
        document.documentElement.dataset['frameMs'] = String(ms);
        if (isMoving) {
            window.setTimeout(() => this.draw(), stillAfterMs);
        } else if (!this.isFinal && !this.layers!.isWaiting && shown.moment === state.moment && shown.domain === state.domain) {
            this.isFinal = true;
            app.say(texts.steps(slices, ms), false);
            document.documentElement.dataset['drawn'] = shown.key;
            document.documentElement.dataset['variants'] = this.renderer.compiledVariants.join('; ');
        }
    }

    private drawOver(geometry: ViewGeometry): void {
        if (this.labels.width !== geometry.width || this.labels.height !== geometry.height) {
            this.labels.width = geometry.width;
            this.labels.height = geometry.height;
        }
        const scale = textScale();
        const taken = [...document.querySelectorAll('header, footer, section, #bar')]
            .map(one => one.getBoundingClientRect())
            .filter(rect => rect.width > 0)
            .map(({ left, top, right, bottom }) => ({ left: left / scale, top: top / scale, right: right / scale, bottom: bottom / scale }));
        const pen = this.labels.getContext('2d')!;
        const ratio = window.devicePixelRatio || 1;
        clearLabels(pen, ratio);
        if (this.app!.state.hasGround) {
            pen.save();
            pen.scale(scale, scale);
            drawLabels(pen, geometry, this.ground!.marks, taken, ratio * scale);
            pen.restore();
        }
        for (const overlay of this.overlays) {
            pen.save();
            overlay(pen, geometry);
            pen.restore();
        }
    }

    // The picture as it is seen, without the controls.
    snapshot(): HTMLCanvasElement {
        const all = document.createElement('canvas');
        all.width = this.picture.width;
        all.height = this.picture.height;
        const pen = all.getContext('2d')!;
        pen.drawImage(this.picture, 0, 0);
        pen.drawImage(this.labels, 0, 0);
        return all;
    }
}
