// Handles the keys of the picture.

import { NamedView, dragged, namedView, usualFieldOfViewDeg, zoomed } from '../camera/controls';
import { App } from './app';
import { Drawing } from './drawing';

const keyStep = 20; // an arrow acts like a drag by this many pixels
const farther = 2; // factor for keys that move the scene

// Returns true if the control with the focus has no use for a key. Arrows scroll a panel, unless it chooses a tilt.
function isUnused({ target, key }: KeyboardEvent): boolean {
    const isButton = target instanceof HTMLButtonElement;
    const isControl = isButton || (target instanceof HTMLInputElement && ['checkbox', 'range'].includes(target.type));
    const isArrow = isButton && key.startsWith('Arrow') && target.closest('#sight, #scan') !== null;
    return isControl && (key === 'Escape' || isArrow || (key.length === 1 && key !== ' '));
}

export class Keys {
    private actions = new Map<string, () => void>();
    private early: KeyboardEvent[] | null = []; // keys that came before their actions; null once all actions are there
    onEarly: () => void = () => undefined; // called when a key comes before its action

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {
        for (const [name, view] of [
            ['t', 'top'],
            ['s', 'south'],
            ['o', 'oblique'],
        ] as const)
            this.add(name, () => this.look(view));
        for (const name of ['+', '=']) this.add(name, () => this.zoom(1.25));
        this.add('-', () => this.zoom(0.8));
        this.add('p', () => this.togglePerspective());
        this.add('0', () => app.resetView());
        this.add('l', () => app.playback.follow());
        this.add(' ', () => app.playback.play());
        this.add(',', () => app.playback.step(-1));
        this.add('.', () => app.playback.step(1));
        this.add('2', () => app.showFlat(true));
        this.add('3', () => app.showFlat(false));
        this.add('ArrowLeft', () => app.playback.step(-1));
        this.add('ArrowRight', () => app.playback.step(1));
    }

    // Adds an action for a key, named as in KeyboardEvent.key or by a lowercase letter. Only Escape may have
    // several actions.
    add(name: string, action: () => void): void {
        const known = this.actions.get(name);
        if (known && name !== 'Escape') throw new Error(`the key '${name}' is taken`);
        this.actions.set(name, () => {
            known?.();
            action();
        });
    }

    // Call when all actions have been added. Carries out the actions of keys that came earlier.
    complete(): void {
        const early = this.early ?? [];
        this.early = null;
        for (const event of early) this.press(event);
    }

    // Handles keys while the picture has the focus or nothing has it, so that keys work before the first click.
    // Buttons, checkboxes and sliders keep only the keys that they use. Other controls keep all keys, so that a user
    // can type.
    begin(): void {
        document.addEventListener('keydown', (event) => {
            const { target } = event;
            const isFree = target === this.drawing.picture || target === document.body;
            if (isFree || (!this.app.isOnMap && isUnused(event))) this.press(event);
        });
    }

    look(view: NamedView): void {
        if (view !== 'top') this.app.showFlat(false);
        this.app.moved(namedView(this.app.state.camera, view));
    }
    togglePerspective(): void {
        const { camera } = this.app.state;
        this.app.moved({ ...camera, fieldOfViewDeg: camera.fieldOfViewDeg > 0 ? 0 : usualFieldOfViewDeg });
    }
    private zoom(factor: number): void {
        const geometry = this.drawing.geometry();
        if (geometry) this.app.moved(zoomed(this.app.state.camera, geometry, factor));
    }

    private press(event: KeyboardEvent): void {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const ways: Record<string, [number, number]> = {
            ArrowLeft: [-keyStep, 0],
            ArrowRight: [keyStep, 0],
            ArrowUp: [0, -keyStep],
            ArrowDown: [0, keyStep],
        };
        const { isFlat } = this.app.state;
        // In 2D, only arrows with Shift move the map.
        const way = isFlat && !event.shiftKey ? undefined : ways[event.key];
        const geometry = this.drawing.geometry();
        const action = this.actions.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
        if (way) {
            const { camera } = this.app.state;
            if (geometry) this.app.moved(dragged(camera, geometry, way, farther, event.shiftKey && !isFlat));
        } else if (action) {
            action();
        } else if (this.early && (event.key.length === 1 || event.key in ways)) {
            this.early.push(event);
            this.onEarly();
        } else {
            return;
        }
        event.preventDefault();
    }
}
