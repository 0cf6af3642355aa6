// Handles mouse and fingers on the picture. They move the camera, unless a tool takes them.

import { dragged, panned, zoomed } from '../camera/controls';
import { paneAt } from '../scene/pane_places';
import { App } from './app';
import { pixelRatio } from './dom';
import { Drawing } from './drawing';

// Takes drags and clicks, in pixels of the picture. If press() returns false or is missing, the drag moves the camera.
// A click is a press that moved less than `farthestClick`.
export interface Tool {
    press?(x: number, y: number): boolean;
    drag?(x: number, y: number): void;
    release?(x: number, y: number): void;
    click?(x: number, y: number): void;
    hover?(x: number, y: number): void;
    end?(): void; // called when another tool takes over
}

const farthestClick = 4; // pixels

export class Pointers {
    private pointers = new Map<number, PointerEvent>();
    private travelled = 0;
    private taker: Tool | null = null; // tool that has taken the press
    private grip: Tool = {}; // takes presses that the tool leaves
    private usual: Tool = {};
    private tool: Tool = this.usual;
    // Pixels of the last click and of the resting pointer, until the usual tool has come.
    private early: { click: [number, number] | null; hover: [number, number] | null } = { click: null, hover: null };

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    get current(): Tool {
        return this.tool;
    }
    // Gives the pointer to another tool; null gives it to the usual tool.
    use(tool: Tool | null): void {
        this.tool.end?.();
        this.tool = tool ?? this.usual;
        this.drawing.drawMarks();
    }

    // Lets a tool take presses that no other tool wants, such as those on the ends of a section.
    setGrip(tool: Tool): void {
        this.grip = tool;
    }

    // Sets the usual tool, and gives it what the pointer did before the tool came.
    setUsual(tool: Tool): void {
        const { click, hover } = this.early;
        this.early = { click: null, hover: null };
        this.usual = tool;
        this.use(null);
        if (hover) tool.hover?.(...hover);
        if (click) tool.click?.(...click);
    }

    begin(): void {
        const { picture } = this.drawing;
        picture.addEventListener('pointerdown', (event) => this.down(event));
        picture.addEventListener('pointermove', (event) => this.move(event));
        picture.addEventListener('pointerup', (event) => this.up(event));
        picture.addEventListener('pointercancel', (event) => this.up(event));
        picture.addEventListener('pointerleave', () => (this.early.hover = null));
        picture.addEventListener('contextmenu', (event) => event.preventDefault());
        picture.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    }

    // Returns the pixel of the pane under the pointer, or of the pane that was pressed.
    private at(event: MouseEvent): [number, number] {
        const [x, y] = [event.offsetX * pixelRatio(), event.offsetY * pixelRatio()];
        const { places } = this.drawing;
        if (this.pointers.size === 0) this.drawing.pointed = paneAt(places, x, y);
        const { left, top } = places[this.drawing.pointed] ?? places[0]!;
        return [x - left, y - top];
    }

    private down(event: PointerEvent): void {
        this.drawing.picture.setPointerCapture(event.pointerId);
        const at = this.at(event);
        this.drawing.activate(this.drawing.pointed);
        this.pointers.set(event.pointerId, event);
        this.travelled = 0;
        const isPlain = this.pointers.size === 1 && event.button === 0 && !event.shiftKey;
        this.taker = isPlain ? ([this.tool, this.grip].find((one) => one.press?.(...at)) ?? null) : null;
    }

    private move(event: PointerEvent): void {
        const before = this.pointers.get(event.pointerId);
        if (!before) {
            this.early.hover = this.at(event);
            return this.tool.hover?.(...this.at(event));
        }
        const geometry = this.drawing.geometry();
        if (!geometry) return;
        const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
        this.travelled += Math.abs(dx) + Math.abs(dy);
        this.pointers.set(event.pointerId, event);
        const { camera, isFlat } = this.app.state;
        if (this.pointers.size === 2) {
            this.pinch(before, event, dx, dy);
        } else if (this.taker) {
            this.taker.drag?.(...this.at(event));
        } else {
            const isOther = !isFlat && (event.shiftKey || (event.buttons & 2) !== 0);
            this.app.moved(dragged(camera, geometry, [dx, dy], pixelRatio(), isOther));
        }
    }

    private pinch(before: PointerEvent, event: PointerEvent, dx: number, dy: number): void {
        const geometry = this.drawing.geometry()!;
        const fixed = [...this.pointers.values()].find((one) => one.pointerId !== event.pointerId)!;
        const was = Math.hypot(before.clientX - fixed.clientX, before.clientY - fixed.clientY);
        const is = Math.hypot(event.clientX - fixed.clientX, event.clientY - fixed.clientY);
        // Keep the place between the fingers.
        const { left, top } = this.drawing.picture.getBoundingClientRect();
        const place = this.drawing.places[this.drawing.pointed] ?? { left: 0, top: 0 };
        const x = ((fixed.clientX + before.clientX) / 2 - left) * pixelRatio() - place.left;
        const y = ((fixed.clientY + before.clientY) / 2 - top) * pixelRatio() - place.top;
        const nearer = zoomed(this.app.state.camera, geometry, is / Math.max(1, was), x, y);
        this.app.moved(panned(nearer, geometry, (dx / 2) * pixelRatio(), (dy / 2) * pixelRatio()));
    }

    private up(event: PointerEvent): void {
        const at = this.at(event);
        if (!this.pointers.delete(event.pointerId)) return;
        this.taker?.release?.(...at);
        this.taker = null;
        if (event.type !== 'pointerup' || this.travelled >= farthestClick) return;
        this.early.click = at;
        this.tool.click?.(...at);
    }

    private wheel(event: WheelEvent): void {
        event.preventDefault();
        const geometry = this.drawing.geometry();
        if (geometry)
            this.app.moved(
                zoomed(this.app.state.camera, geometry, Math.exp(-event.deltaY * 0.0015), ...this.at(event)),
            );
    }
}
