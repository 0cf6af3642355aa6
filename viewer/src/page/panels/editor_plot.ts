// Draws the plot of the editor: a histogram of the values, their opacity and color, and handles for the points of
// color, for the points of opacity, and for the threshold.

import { shades } from '../../renderer/shades';
import { colorOf, extinctionPerM } from '../../tables/color_table';
import { ColorTable } from '../../wire/color_tables';
import { Draft, OpacityPoint } from '../../tables/draft';
import { ShownUnit } from '../../tables/units';
import { stepOf } from '../color_bar';
import { fontOf, make, penOf, textScale } from '../dom';
import { editorTexts, panelTexts } from '../later_texts';

export type Kind = 'color' | 'opacity' | 'least';
export interface Selection {
    kind: Kind;
    at: number;
}
export interface PlotContent {
    draft: Draft;
    opacity: OpacityPoint[]; // points of the draft, or points made of the usual opacity
    table: ColorTable; // table of the picture
    least: number; // threshold; at the start of the axis it hides nothing
    histogram: Uint32Array | null;
    unit: ShownUnit;
    selected: Selection;
}
// Actions of the user on points, in values of the axes.
export interface PlotActions {
    select(selection: Selection): void;
    move(selection: Selection, value: number, perKm: number | null, doing: string): void;
    add(kind: 'color' | 'opacity', value: number, perKm: number): void;
    remove(selection: Selection): void;
    rest(): void;
}

// Margins in pixels of the plot, which are larger on large screens.
const [left, right, top, below] = [34, 8, 16, 48];
const stripHeight = 16;
const colorHandleBelow = 25; // so far below the lowest opacity that no handle covers another
const farthestClick = 4;
// Ends of the axis of opacity, which is logarithmic. Lower opacities are clear.
const [leastPerKm, mostPerKm] = [0.0005, 30];

export class EditorPlot {
    readonly box = make('div', { class: 'plot' });
    private canvas = make('canvas', { 'aria-hidden': 'true' });
    private handles: Record<Kind, HTMLElement[]> = { color: [], opacity: [], least: [] };
    private groups: Record<Kind, HTMLElement>;
    private content!: PlotContent; // set by show(), which the editor calls first
    private drags = 0;
    private scale = 1; // pixels of the page in a pixel of the plot

    constructor(private actions: PlotActions) {
        this.canvas.addEventListener('pointerup', (event) => this.addAt(event));
        this.groups = {
            least: this.group(panelTexts.threshold),
            opacity: this.group(editorTexts.opacities),
            color: this.group(editorTexts.colors),
        };
        this.box.append(this.canvas, ...Object.values(this.groups));
    }

    private group(name: string): HTMLElement {
        return make('div', { role: 'group', 'aria-label': name });
    }

    // -- axes

    range(): [number, number] {
        const { draft } = this.content;
        return [draft.barBegin, Math.max(draft.end, draft.colors[draft.colors.length - 1]!.value)];
    }
    get columns(): number {
        return Math.max(1, Math.round((this.width - left - right) / 2));
    }
    private get width(): number {
        return this.box.clientWidth / this.scale;
    }
    private xOf(value: number): number {
        const [low, high] = this.range();
        const share = Math.min(1, Math.max(0, (value - low) / (high - low)));
        return left + share * (this.width - left - right);
    }
    private valueOf(x: number): number {
        const [low, high] = this.range();
        return low + ((x - left) / (this.width - left - right)) * (high - low);
    }
    private get bottom(): number {
        return this.box.clientHeight / this.scale - below;
    }
    private yOf(perKm: number): number {
        if (perKm < leastPerKm) return this.bottom;
        const share = Math.log(perKm / leastPerKm) / Math.log(mostPerKm / leastPerKm);
        return this.bottom - Math.min(1, share) * (this.bottom - top);
    }
    private perKmOf(y: number): number {
        const share = (this.bottom - y) / (this.bottom - top);
        return share <= 0 ? 0 : leastPerKm * (mostPerKm / leastPerKm) ** Math.min(1, share);
    }

    // -- drawing

    show(content: PlotContent): void {
        this.content = content;
        if (this.box.clientWidth === 0) return;
        this.draw();
        this.putHandles('color', content.draft.colors.length);
        this.putHandles('opacity', content.opacity.length);
        this.putHandles('least', 1);
    }

    private draw(): void {
        this.scale = textScale();
        const pen = penOf(this.canvas);
        pen.font = fontOf(12);
        this.drawAxes(pen);
        this.drawHistogram(pen);
        this.drawOpacity(pen);
        this.drawStrip(pen);
    }

    private drawAxes(pen: CanvasRenderingContext2D): void {
        const { unit } = this.content;
        pen.textBaseline = 'middle';
        pen.textAlign = 'right';
        for (const perKm of [0.001, 0.01, 0.1, 1, 10]) {
            const y = this.yOf(perKm);
            pen.fillStyle = shades.axis;
            pen.fillRect(left, Math.round(y), this.width - left - right, 1);
            pen.fillStyle = shades.quietText;
            pen.fillText(String(perKm).replace(/^0/, ''), left - 4, y);
        }
        pen.fillText(editorTexts.perKm, left - 4, 7);
        const [low, high] = this.range().map((value) => value * unit.perStored) as [number, number];
        const step = stepOf(high - low);
        pen.textAlign = 'center';
        const y = this.bottom + below - 7;
        for (let number = Math.ceil(low / step) * step; number <= high + 1e-9; number += step) {
            const x = this.xOf(number / unit.perStored);
            if (x > this.width - right - 36) break;
            pen.fillText(String(Number(number.toFixed(3))), Math.max(left + 4, x), y);
        }
        pen.textAlign = 'right';
        pen.fillText(unit.symbol, this.width - right, y);
    }

    private drawHistogram(pen: CanvasRenderingContext2D): void {
        const { histogram } = this.content;
        if (!histogram) return;
        const most = Math.log1p(Math.max(1, ...histogram));
        const width = (this.width - left - right) / histogram.length;
        pen.fillStyle = shades.histogram;
        histogram.forEach((count, i) => {
            const height = (Math.log1p(count) / most) * (this.bottom - top);
            pen.fillRect(left + i * width, this.bottom - height, width, height);
        });
    }

    private isHidden(value: number): boolean {
        return value < this.content.least;
    }

    private drawOpacity(pen: CanvasRenderingContext2D): void {
        const { table } = this.content;
        const [from, to] = [left, this.width - right];
        const yAt = (x: number) => this.yOf(1000 * extinctionPerM(table, this.valueOf(x), 1));
        const column = 1 / this.scale;
        for (let x = from; x < to; x += column) {
            const color = colorOf(table, this.valueOf(x + 0.5 * column));
            if (!color || this.isHidden(this.valueOf(x + 0.5 * column))) continue;
            pen.fillStyle = `rgba(${color[0]}, ${color[1]}, ${color[2]}, 0.4)`;
            pen.fillRect(x, yAt(x + 0.5 * column), column, this.bottom - yAt(x + 0.5 * column));
        }
        pen.beginPath();
        for (let x = from; x <= to; ++x) pen.lineTo(x, yAt(x));
        pen.strokeStyle = shades.text;
        pen.lineWidth = 1.5;
        pen.stroke();
    }

    private drawStrip(pen: CanvasRenderingContext2D): void {
        const { table } = this.content;
        const column = 1 / this.scale;
        for (let x = left; x < this.width - right; x += column) {
            const color = colorOf(table, this.valueOf(x + 0.5 * column));
            if (!color) continue;
            pen.globalAlpha = this.isHidden(this.valueOf(x + 0.5 * column)) ? 0.15 : 1;
            pen.fillStyle = `rgb(${color[0]}, ${color[1]}, ${color[2]})`;
            pen.fillRect(x, this.bottom + 4, column, stripHeight - 4);
        }
        pen.globalAlpha = 1;
    }

    // -- handles

    // Makes the handles of a group. Tab reaches one handle of each group, and Page keys go to the other handles.
    private putHandles(kind: Kind, count: number): void {
        const handles = this.handles[kind];
        while (handles.length > count) handles.pop()!.remove();
        while (handles.length < count) handles.push(this.makeHandle(kind, handles.length));
        const { selected } = this.content;
        const current = selected.kind === kind ? Math.min(count - 1, selected.at) : 0;
        handles.forEach((handle, i) => {
            handle.tabIndex = i === current ? 0 : -1;
            handle.classList.toggle('selected', selected.kind === kind && i === current);
            this.placeHandle(handle, kind, i);
        });
    }

    private placeHandle(handle: HTMLElement, kind: Kind, i: number): void {
        const { draft, opacity, least, unit } = this.content;
        const value = kind === 'color' ? draft.colors[i]!.value : kind === 'opacity' ? opacity[i]!.value : least;
        const color = kind === 'color' ? draft.colors[i]!.color : null;
        const perKm = kind === 'opacity' ? opacity[i]!.perKm : null;
        const y = perKm !== null ? this.yOf(perKm) : color ? this.bottom + colorHandleBelow : top - 6;
        handle.style.left = `${this.scale * this.xOf(value)}px`;
        handle.style.top = `${this.scale * y}px`;
        if (color) handle.style.backgroundColor = `rgb(${color[0]}, ${color[1]}, ${color[2]})`;
        if (kind === 'least') handle.style.setProperty('--line', `${this.scale * (this.bottom - top + 6)}px`);
        const [low, high] = this.range();
        const shown = `${Number((value * unit.perStored).toFixed(3))} ${unit.symbol}`.trim();
        handle.setAttribute('aria-valuemin', String(Math.min(low, value)));
        handle.setAttribute('aria-valuemax', String(Math.max(high, value)));
        handle.setAttribute('aria-valuenow', String(value));
        handle.setAttribute(
            'aria-valuetext',
            perKm !== null ? editorTexts.opacityIs(shown, perKm) : color ? editorTexts.colorIs(shown, color) : shown,
        );
        handle.setAttribute('aria-label', kind === 'least' ? panelTexts.threshold : editorTexts.point(kind, i + 1));
    }

    focus({ kind, at }: Selection): void {
        this.handles[kind][at]?.focus();
    }

    private makeHandle(kind: Kind, at: number): HTMLElement {
        const handle = make('div', { class: `handle ${kind}`, role: 'slider' });
        const selection = { kind, at };
        handle.addEventListener('focus', () => this.actions.select(selection));
        handle.addEventListener('keydown', (event) => this.press(event, selection));
        handle.addEventListener('keyup', () => this.actions.rest());
        let drag: { x: number; y: number; isMoved: boolean; doing: string } | null = null;
        handle.addEventListener('pointerdown', (event) => {
            handle.setPointerCapture(event.pointerId);
            handle.focus();
            drag = { x: event.clientX, y: event.clientY, isMoved: false, doing: `drag ${++this.drags}` };
            event.preventDefault();
        });
        handle.addEventListener('pointermove', (event) => {
            if (!drag) return;
            drag.isMoved ||= Math.hypot(event.clientX - drag.x, event.clientY - drag.y) >= farthestClick;
            if (drag.isMoved) this.actions.move(selection, ...this.at(event), drag.doing);
        });
        for (const end of ['pointerup', 'pointercancel'] as const) {
            handle.addEventListener(end, () => {
                drag = null;
                this.actions.rest();
            });
        }
        this.groups[kind].append(handle);
        return handle;
    }

    private at(event: MouseEvent): [number, number] {
        const box = this.box.getBoundingClientRect();
        return [
            this.valueOf((event.clientX - box.left) / this.scale),
            this.perKmOf((event.clientY - box.top) / this.scale),
        ];
    }

    private addAt(event: PointerEvent): void {
        if (event.button !== 0) return;
        const box = this.box.getBoundingClientRect();
        const isColor = (event.clientY - box.top) / this.scale > this.bottom;
        this.actions.add(isColor ? 'color' : 'opacity', ...this.at(event));
    }

    private press(event: KeyboardEvent, selection: Selection): void {
        const { kind, at } = selection;
        const { draft, opacity, least } = this.content;
        const [low, high] = this.range();
        const step = ((high - low) / 200) * (event.shiftKey ? 10 : 1);
        const value = kind === 'color' ? draft.colors[at]!.value : kind === 'opacity' ? opacity[at]!.value : least;
        const perKm = kind === 'opacity' ? opacity[at]!.perKm : null;
        const sideways = { ArrowLeft: -step, ArrowRight: step }[event.key];
        const upward = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        const to = { PageUp: at + 1, PageDown: at - 1, Home: 0, End: this.handles[kind].length - 1 }[event.key];
        const doing = `keys ${kind} ${at}`;
        if (sideways !== undefined) {
            this.actions.move(selection, value + sideways, perKm, doing);
        } else if (upward !== undefined && perKm !== null) {
            // Count a step up from opacity 0 as a step from the start of the axis.
            const next = Math.max(perKm, leastPerKm) * (event.shiftKey ? 2 : 1.1) ** upward;
            this.actions.move(selection, value, next < leastPerKm ? 0 : next, doing);
        } else if (upward !== undefined) {
            this.actions.move(selection, value + upward * step, perKm, doing);
        } else if (to !== undefined && this.handles[kind][to]) {
            this.focus({ kind, at: to });
        } else if ((event.key === 'Delete' || event.key === 'Backspace') && kind !== 'least') {
            this.actions.remove(selection);
        } else if (event.key === 'Insert' && kind !== 'least') {
            this.actions.add(kind, this.middleAfter(kind, at), NaN);
        } else {
            return;
        }
        event.preventDefault();
        event.stopPropagation();
    }

    // Returns the value half way between a point and the next point. For the last point, returns the value half way to
    // the point before, or to the end of the axis if there is only one point.
    middleAfter(kind: 'color' | 'opacity', at: number): number {
        const points: { value: number }[] = kind === 'color' ? this.content.draft.colors : this.content.opacity;
        const first = Math.max(0, Math.min(at, points.length - 2));
        const [here, next] = [points[first]!, points[first + 1]];
        return next ? (here.value + next.value) / 2 : here.value + (this.range()[1] - here.value) / 2;
    }
}
