// Handles mouse and fingers on the start map.

import { Pixel } from '../../map/places';

export interface Pointed {
    readonly boxes: boolean;
    move(dx: number, dy: number): void;
    zoom(factor: number, x?: number, y?: number): void;
    point(x: number, y: number): void;
    at(x: number, y: number): string | null;
    open(domain: string | null): Promise<void>;
    drawBox(from: Pixel, to: Pixel): void;
    dropBox(): void;
    openBox(): Promise<void>;
}

const farthestClick = 5; // pixels

export class MapPointers {
    private pointers = new Map<number, PointerEvent>();
    private begun: Pixel = [0, 0];
    private travelled = 0;
    private isBox = false;

    constructor(
        private canvas: HTMLCanvasElement,
        private map: Pointed,
    ) {}

    begin(): void {
        const { canvas } = this;
        canvas.addEventListener('pointerdown', (event) => this.down(event));
        canvas.addEventListener('pointermove', (event) => this.moved(event));
        canvas.addEventListener('pointerup', (event) => this.up(event));
        canvas.addEventListener('pointercancel', (event) => this.up(event));
        canvas.addEventListener(
            'wheel',
            (event) => {
                event.preventDefault();
                this.map.zoom(Math.exp(-event.deltaY * 0.002), event.offsetX, event.offsetY);
            },
            { passive: false },
        );
    }

    private down(event: PointerEvent): void {
        this.canvas.setPointerCapture(event.pointerId);
        this.pointers.set(event.pointerId, event);
        if (this.pointers.size > 1) {
            this.travelled = Infinity; // this is not a click
            if (this.isBox) this.map.dropBox();
            this.isBox = false;
            return;
        }
        this.begun = [event.offsetX, event.offsetY];
        this.travelled = 0;
        this.isBox = this.map.boxes || event.shiftKey;
    }

    private moved(event: PointerEvent): void {
        const before = this.pointers.get(event.pointerId);
        if (!before) {
            if (event.pointerType !== 'touch') this.map.point(event.offsetX, event.offsetY);
            return;
        }
        const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
        this.pointers.set(event.pointerId, event);
        this.travelled += Math.abs(dx) + Math.abs(dy);
        if (this.pointers.size === 2) this.pinch(before, event);
        else if (this.isBox) this.map.drawBox(this.begun, [event.offsetX, event.offsetY]);
        else this.map.move(dx, dy);
    }

    private pinch(before: PointerEvent, event: PointerEvent): void {
        const fixed = [...this.pointers.values()].find((one) => one.pointerId !== event.pointerId)!;
        const distance = (one: PointerEvent) => Math.hypot(one.clientX - fixed.clientX, one.clientY - fixed.clientY);
        this.map.zoom(
            distance(event) / Math.max(1, distance(before)),
            (event.offsetX + fixed.offsetX) / 2,
            (event.offsetY + fixed.offsetY) / 2,
        );
        this.map.move((event.clientX - before.clientX) / 2, (event.clientY - before.clientY) / 2);
    }

    private up(event: PointerEvent): void {
        if (!this.pointers.delete(event.pointerId)) return;
        const isClick = event.type === 'pointerup' && this.travelled < farthestClick;
        if (this.isBox && !isClick) {
            if (event.type === 'pointerup') void this.map.openBox();
            else this.map.dropBox();
        } else if (isClick) void this.map.open(this.map.at(event.offsetX, event.offsetY));
        this.isBox = false;
    }
}
