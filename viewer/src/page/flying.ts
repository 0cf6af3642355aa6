// Lets the user fly: W, A, S and D move the eye, E and Q move it up and down, drags and arrows turn it.

import { Window, flown, landed, speedOf, takenOff, turned } from '../camera/fly';
import { App } from './app';
import { pixelRatio } from './dom';
import { Drawing } from './drawing';
import { Tool } from './pointers';
import { boxOf } from '../scene/grid_box';

const degreesAPixel = 0.2;
const degreesASecond = 60; // turn by arrows
const faster = 4; // with Shift
const ways: Record<string, [number, number, number]> = {
    w: [1, 0, 0],
    s: [-1, 0, 0],
    a: [0, -1, 0],
    d: [0, 1, 0],
    e: [0, 0, 1],
    q: [0, 0, -1],
};
const turns: Record<string, [number, number]> = {
    arrowleft: [-1, 0],
    arrowright: [1, 0],
    arrowup: [0, 1],
    arrowdown: [0, -1],
};

export class FlyTool implements Tool {
    private held = new Set<string>();
    private last: [number, number] = [0, 0];
    private before = 0; // time of the last move, in ms
    private isFast = false;
    private readonly down = (event: KeyboardEvent) => this.key(event, true);
    private readonly up = (event: KeyboardEvent) => this.key(event, false);
    private readonly lost = () => this.held.clear();

    constructor(
        private app: App,
        private drawing: Drawing,
        private ended: () => void,
    ) {
        const view = this.window();
        if (view) app.moved(takenOff(app.state.camera, view));
        // Take keys before the picture does, which uses some of them for other actions.
        document.addEventListener('keydown', this.down, { capture: true });
        document.addEventListener('keyup', this.up, { capture: true });
        window.addEventListener('blur', this.lost);
        drawing.picture.focus();
    }

    end(): void {
        document.removeEventListener('keydown', this.down, { capture: true });
        document.removeEventListener('keyup', this.up, { capture: true });
        window.removeEventListener('blur', this.lost);
        this.held.clear();
        const view = this.window();
        if (view) this.app.moved(landed(this.app.state.camera, view));
        this.ended();
    }

    press(x: number, y: number): boolean {
        this.last = [x, y];
        return true;
    }
    drag(x: number, y: number): void {
        const view = this.window();
        const [dx, dy] = [(x - this.last[0]) / pixelRatio(), (y - this.last[1]) / pixelRatio()];
        this.last = [x, y];
        if (view) this.app.moved(turned(this.app.state.camera, view, dx * degreesAPixel, -dy * degreesAPixel));
    }

    private window(): Window | null {
        const geometry = this.drawing.geometry();
        const { shown, state } = this.app;
        return (
            shown &&
            geometry && {
                box: boxOf(shown.loaded.grid),
                exaggeration: state.exaggeration,
                width: geometry.width,
                height: geometry.height,
            }
        );
    }

    private key(event: KeyboardEvent, isDown: boolean): void {
        this.isFast = event.shiftKey;
        const name = event.key.toLowerCase();
        const isOurs = (name in ways || name in turns) && !event.ctrlKey && !event.metaKey && !event.altKey;
        if (!isOurs || (event.target !== this.drawing.picture && event.target !== document.body)) return;
        event.stopPropagation();
        event.preventDefault();
        if (!isDown) this.held.delete(name);
        else if (!this.held.has(name)) {
            this.held.add(name);
            if (this.held.size === 1) {
                this.before = performance.now();
                requestAnimationFrame(() => this.move());
            }
        }
    }

    // Moves the camera by the held keys, for the time since the last move but at most half a second.
    private move(): void {
        const view = this.window();
        if (this.held.size === 0 || !view) return;
        const now = performance.now();
        const seconds = Math.min(0.5, (now - this.before) / 1000);
        this.before = now;
        let { camera } = this.app.state;
        const meters = speedOf(camera, view) * seconds * (this.isFast ? faster : 1);
        for (const name of this.held) {
            const [way, turn] = [ways[name], turns[name]];
            if (way) camera = flown(camera, view, way[0] * meters, way[1] * meters, way[2] * meters);
            if (turn)
                camera = turned(camera, view, turn[0] * degreesASecond * seconds, turn[1] * degreesASecond * seconds);
        }
        this.app.moved(camera);
        requestAnimationFrame(() => this.move());
    }
}
