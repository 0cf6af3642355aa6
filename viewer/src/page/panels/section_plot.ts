// Plots the section over distance and height, and shows the value under the pointer.

import { Section, cutSection, greatestOf } from '../../fields/section';
import { shades } from '../../renderer/shades';
import { lookOver, looksOf } from '../../tables/looks';
import { ColorTable } from '../../wire/color_tables';
import { distanceText, heightText, valueText } from '../../tables/units';
import { CellState } from '../../wire/packed_grid';
import { App } from '../app';
import { fontOf, labeledButton, make, pixelRatio, press, textScale } from '../dom';
import { Drawing } from '../drawing';
import { plotTexts } from '../later_texts';
import { stateText, texts } from '../texts';

const [left, right, top, bottom] = [34, 12, 8, 22]; // room for the axes, in pixels of the page
const keyStep = 4;
const hatchPeriod = 9;

// Returns the reason why a section has no value.
function nothingIn({ field, inGrid }: Section): string {
    if (!inGrid.includes(1)) return texts.layers.beyond;
    if (field.states.includes(CellState.ambiguous)) return plotTexts.nothingButAmbiguous;
    if (field.states.includes(CellState.rangeFolded)) return plotTexts.nothingButFolded;
    return field.states.includes(CellState.noEcho) ? plotTexts.nothing : texts.notSeen;
}

function tickStep(range: number, most: number): number {
    const power = 10 ** Math.floor(Math.log10(range / most));
    return [1, 2, 5, 10].map((step) => step * power).find((step) => range / step <= most) ?? 10 * power;
}

// Returns the pixels of a section, one for each of its places. Colors are as in `stormcellar frame --product section`.
export function sectionPixels(section: Section, table: ColorTable, least: number | null): Uint8ClampedArray {
    const { field, inGrid } = section;
    const { width, height } = field;
    const looks = looksOf(table, least ?? -1e9);
    const pixels = new Uint8ClampedArray(4 * width * height);
    for (let y = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x) {
            const from = (height - 1 - y) * width + x;
            const state = field.states[from];
            const isHatched = (x + y) % hatchPeriod === 0;
            let color: readonly number[] = shades.seen;
            if (inGrid[x] === 0) color = shades.page;
            else if (state === CellState.value)
                color = lookOver(looks, field.values[from]!, shades.seen) ?? shades.seen;
            else if (state === CellState.rangeFolded) color = table.range_folded;
            else if (state === CellState.ambiguous) color = isHatched ? table.range_folded : shades.seen;
            else if (state === CellState.notSeen) color = isHatched ? shades.hatch : shades.notSeen;
            pixels.set([color[0]!, color[1]!, color[2]!, 255], 4 * (y * width + x));
        }
    }
    return pixels;
}

export class SectionPlot {
    private canvas = make('canvas', {
        id: 'section-canvas',
        tabindex: '0',
        role: 'img',
        'aria-label': plotTexts.plot,
    });
    private reading = make('output', { id: 'section-reading' });
    private larger = labeledButton('section-larger', '⤢', plotTexts.larger, () => this.enlarge());
    private box = make('section', { id: 'section-plot', hidden: '' }, this.larger, this.canvas, this.reading);
    private section: Section | null = null;
    private cursor: [number, number] | null = null; // in pixels of the plot
    private drawn: readonly unknown[] = [];

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {
        document.querySelector('main')!.append(this.box);
        this.canvas.addEventListener('pointermove', (event) =>
            this.point([event.offsetX / textScale() - left, event.offsetY / textScale() - top]),
        );
        this.canvas.addEventListener('pointerleave', () => this.point(null));
        this.canvas.addEventListener('keydown', (event) => this.pressKey(event));
        this.canvas.addEventListener('blur', () => this.point(null));
        window.addEventListener('resize', () => this.put());
        app.on(['view', 'shown', 'units', 'cells'], () => this.put());
    }

    // Returns the size of the picture without its axes, in pixels that are larger on large screens.
    private get size(): [number, number] {
        const [width, height] = [this.canvas.clientWidth / textScale(), this.canvas.clientHeight / textScale()];
        return [Math.max(16, width - left - right), Math.max(16, height - top - bottom)];
    }

    put(): void {
        const { shown, table, state } = this.app;
        const ends = state.layers.section;
        const hasBeenHidden = this.box.hidden;
        const cells = shown && ends && this.drawing.windows.along(shown.loaded, ends);
        this.box.hidden = !cells || !table;
        if (!cells || !table) {
            this.drawn = [];
            return;
        }
        const [width, height] = this.size;
        const now = [ends, cells, table, state.least, state.units, width, height];
        if (!hasBeenHidden && now.every((part, i) => part === this.drawn[i])) return;
        this.drawn = now;
        const ratio = pixelRatio() * textScale();
        this.section = cutSection(
            cells.grid,
            shown.moment,
            ends[0],
            ends[1],
            Math.round(width * ratio),
            Math.round(height * ratio),
        );
        this.draw();
        this.say();
    }

    private enlarge(): void {
        const isLarge = this.box.classList.toggle('large');
        press('section-larger', isLarge);
        this.put();
    }

    private draw(): void {
        const { section } = this;
        const { shownTable: table, state } = this.app;
        if (!section || !table) return;
        const ratio = pixelRatio() * textScale();
        const [width, height] = this.size;
        this.canvas.width = Math.round((left + width + right) * ratio);
        this.canvas.height = Math.round((top + height + bottom) * ratio);
        const pen = this.canvas.getContext('2d')!;
        const { field } = section;
        const image = new ImageData(field.width, field.height);
        image.data.set(sectionPixels(section, table, state.least));
        pen.putImageData(image, Math.round(left * ratio), Math.round(top * ratio));
        pen.scale(ratio, ratio);
        this.drawAxes(pen, section, width, height);
        if (!this.cursor) return;
        const [x, y] = this.cursor;
        pen.strokeStyle = shades.text;
        pen.lineWidth = 1;
        pen.strokeRect(left + 0.5, top + y, width - 1, 0);
        pen.strokeRect(left + x, top + 0.5, 0, height - 1);
    }

    private drawAxes(
        pen: CanvasRenderingContext2D,
        { lengthM, bottomM, topM }: Section,
        width: number,
        height: number,
    ): void {
        pen.font = fontOf(11);
        pen.fillStyle = shades.quietText;
        pen.textAlign = 'right';
        pen.textBaseline = 'middle';
        const { height: up, distance: along } = this.app.state.units;
        const upStep = tickStep((topM - bottomM) / up.si, Math.max(2, height / 28)) * up.si;
        for (let at = Math.ceil(bottomM / upStep) * upStep; at <= topM; at += upStep) {
            const y = top + height * (1 - (at - bottomM) / (topM - bottomM));
            pen.fillRect(left - 3, Math.round(y), 3, 1);
            pen.fillText(String(Number((at / up.si).toFixed(2))), left - 6, Math.min(y, top + height - 4));
        }
        pen.textAlign = 'center';
        const alongStep = tickStep(lengthM / along.si, Math.max(2, width / 60)) * along.si;
        for (let at = alongStep; at < lengthM * 0.93; at += alongStep) {
            const x = left + (width * at) / lengthM;
            pen.fillRect(Math.round(x), top + height, 1, 3);
            pen.fillText(String(Number((at / along.si).toFixed(2))), x, top + height + 13);
        }
        pen.fillStyle = shades.text;
        pen.font = fontOf(12, 'bold');
        pen.fillText('A', left + 4, top + height + 12);
        pen.fillText('B', left + width - 4, top + height + 12);
        pen.font = fontOf(11);
        pen.textAlign = 'left';
        pen.fillText(up.symbol === along.symbol ? up.symbol : `${up.symbol}, ${along.symbol}`, 2, top + height + 13);
    }

    private point(at: [number, number] | null): void {
        const [width, height] = this.size;
        this.cursor = at && at[0] >= 0 && at[1] >= 0 && at[0] < width && at[1] < height ? at : null;
        this.draw();
        this.say();
    }

    private pressKey(event: KeyboardEvent): void {
        const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
        if (!way) return;
        event.preventDefault();
        const [width, height] = this.size;
        const [x, y] = this.cursor ?? [width / 2, height / 2];
        const bounded = (at: number, most: number) => Math.min(most - 1, Math.max(0, at));
        this.point([bounded(x + keyStep * way[0]!, width), bounded(y + keyStep * way[1]!, height)]);
    }

    private say(): void {
        const { section, app } = this;
        if (!section) return;
        const { units } = app.state;
        const told = (what: string, distanceM: number, heightM: number) =>
            plotTexts.told(what, distanceText(distanceM, units), heightText(heightM, units));
        const ofValue = (value: number) => valueText(value, app.unit, units, 1);
        if (!this.cursor) {
            const greatest = greatestOf(section);
            this.reading.textContent = greatest
                ? plotTexts.greatest(told(ofValue(greatest.value), greatest.distanceM, greatest.heightM))
                : nothingIn(section);
            return;
        }
        const [width, height] = this.size;
        const { field, inGrid, lengthM, bottomM, topM } = section;
        const column = Math.min(field.width - 1, Math.floor((this.cursor[0] / width) * field.width));
        const row = Math.max(0, field.height - 1 - Math.floor((this.cursor[1] / height) * field.height));
        const at = row * field.width + column;
        const distanceM = ((column + 0.5) / field.width) * lengthM;
        const heightM = bottomM + ((row + 0.5) / field.height) * (topM - bottomM);
        const state = field.states[at] as CellState;
        const inside = () => (state === CellState.value ? ofValue(field.values[at]!) : stateText(state));
        const what = inGrid[column] === 0 ? texts.layers.beyond : inside();
        this.reading.textContent = told(what, distanceM, heightM);
    }
}
