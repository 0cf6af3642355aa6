// The panel of layers: what is drawn beside the map, and its keys.

import { cutsOf, isChosen } from '../../fields/sweep_choice';
import { Crop, Layers, isBelow, sectionOf, sectionText, toggledFolded, veilsFolded } from '../../scene/layers';
import { planeOf } from '../../earth/projection';
import { distanceText, heightText, valueText } from '../../tables/units';
import { App } from '../app';
import { button, element, leaveByEscape, putOptions } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { cutText } from '../layer_maker';
import { CropTool, SectionTool, acrossView, addMarks, wholeBox } from '../layer_tools';
import { Pointers } from '../pointers';
import { isMoment } from '../../wire/moments';
import { texts } from '../texts';
import { openSettings } from './look';
import { SectionPlot } from './section_plot';

const words = texts.layers;
const usualPlaneM = 3000;
const planeStepM = 500;
const usualReflectivity = 45;
const lowestSweepDeg = 0.5; // the nearest is shown
const sides = ['westM', 'eastM', 'southM', 'northM', 'bottomM', 'topM'] as const;

function labeled(text: string, control: HTMLElement): HTMLLabelElement {
    const label = document.createElement('label');
    const name = document.createElement('span');
    name.textContent = text;
    label.append(name, control);
    return label;
}

function input(id: string, type: string): HTMLInputElement {
    const made = document.createElement('input');
    made.id = id;
    made.type = type;
    return made;
}

export class LayersPanel {
    private box = document.createElement('section');
    private told = document.createElement('p'); // which layers are shown, under the title
    private parts = new Map<string, HTMLElement>(); // what is shown only while its layer is on

    constructor(
        private app: App,
        private drawing: Drawing,
        private pointers: Pointers,
    ) {}

    begin(keys: Keys): void {
        this.box.id = 'layers';
        this.box.hidden = true;
        this.box.setAttribute('aria-label', words.title);
        element('settings').after(this.box);
        leaveByEscape(this.box, 'layers-open', () => this.open(false));
        const open = button('layers-open', words.title, () => this.open(this.box.hidden));
        open.setAttribute('aria-controls', 'layers');
        open.setAttribute('aria-expanded', 'false');
        element('open').after(open);
        element('open').addEventListener('click', () => this.open(false));
        this.told.id = 'layers-told';
        element('title').after(this.told);
        this.addLayers();
        this.addKeys(keys);
        addMarks(this.app, this.drawing);
        new SectionPlot(this.app, this.drawing.windows);
        for (const happening of ['view', 'shown', 'choices', 'units'] as const)
            this.app.on(happening, () => this.put());
        this.drawing.layers.layerCame = () => this.put();
    }

    private open(isOpen: boolean): void {
        if (isOpen) openSettings(this.drawing, false);
        this.box.hidden = !isOpen;
        element('layers-open').setAttribute('aria-expanded', String(isOpen));
        this.put();
        this.drawing.draw();
    }

    // -- the controls

    private addLayers(): void {
        this.addToggle('volume', words.volume, () => this.set({ hasVolume: !this.layers.hasVolume }));
        this.addToggle('plane', words.plane, () => this.togglePlane(), this.planeParts());
        this.addToggle('section', words.section, () => this.toggleSection(), this.sectionParts());
        this.addToggle('surface', words.surface, () => this.toggleSurface(), this.surfaceParts());
        this.addToggle('maximum', words.maximum, () => this.set({ hasMaximum: !this.layers.hasMaximum }));
        this.addToggle('sweep', words.sweep, () => this.toggleSweep(), this.sweepParts());
        this.addToggle('crop', words.crop, () => this.toggleCrop(), this.cropParts());
        this.addToggle('light', words.light, () => this.set({ isLit: !this.layers.isLit }));
        this.addToggle('haze', words.haze, () => this.set({ hasHaze: !this.layers.hasHaze }));
        this.addToggle('folded', words.folded, () => this.toggleFolded());
    }

    private addToggle(name: string, text: string, act: () => void, parts?: HTMLElement[]): void {
        const box = input(`layer-${name}`, 'checkbox');
        box.addEventListener('change', act);
        const label = labeled(text, box);
        label.className = 'toggle';
        this.box.append(label);
        if (!parts) return;
        const more = document.createElement('div');
        more.append(...parts);
        this.parts.set(name, more);
        this.box.append(more);
    }

    private planeParts(): HTMLElement[] {
        const height = input('plane-height', 'range');
        height.step = String(planeStepM / 5); // and both ends are whole steps
        height.addEventListener('input', () => this.slide({ planeM: Number(height.value) }));
        height.setAttribute('aria-label', words.plane);
        const told = document.createElement('output');
        told.id = 'plane-value';
        return [height, told];
    }

    private sectionParts(): HTMLElement[] {
        const ends = input('section-ends', 'text');
        ends.addEventListener('change', () => {
            const section = sectionOf(ends.value);
            if (section) this.set({ section });
            else this.put();
        });
        return [
            button('section-draw', words.draw, () => this.drawSection()),
            button('section-across', words.across, () => this.cutAcross()),
            button('section-look', words.lookAt, () => this.lookAtSection()),
            labeled(words.ends, ends),
        ];
    }

    private surfaceParts(): HTMLElement[] {
        const value = input('surface-value', 'range');
        value.addEventListener('input', () => {
            const { surface } = this.layers;
            if (surface) this.slide({ surface: { ...surface, value: Number(value.value) } });
        });
        const told = document.createElement('output');
        told.id = 'surface-told';
        const of = document.createElement('select');
        of.id = 'surface-of';
        of.addEventListener('change', () => {
            const moment = of.value === this.app.state.moment ? '' : of.value;
            this.set({ surface: { moment, value: this.usualValue(of.value) } });
        });
        const label = labeled(words.encloses, value);
        label.append(told);
        return [label, labeled(words.surfaceOf, of)];
    }

    private sweepParts(): HTMLElement[] {
        const elevation = document.createElement('select');
        elevation.id = 'sweep-elevation';
        elevation.addEventListener('change', () => this.chooseCut(Number(elevation.value)));
        return [labeled(words.elevation, elevation)];
    }

    private cropParts(): HTMLElement[] {
        const sliders = sides.map((side) => {
            const slider = input(`crop-${side.slice(0, -1)}`, 'range');
            slider.addEventListener('input', () => this.slideCrop(side, Number(slider.value)));
            return labeled(words.sides[side], slider);
        });
        return [button('crop-draw', words.draw, () => this.drawCrop()), ...sliders];
    }

    private addKeys(keys: Keys): void {
        keys.add('v', () => this.set({ hasVolume: !this.layers.hasVolume }));
        keys.add('c', () => this.togglePlane());
        keys.add('[', () => this.movePlane(-planeStepM));
        keys.add(']', () => this.movePlane(planeStepM));
        keys.add('x', () => this.toggleSection());
        keys.add('a', () => this.lookAtSection());
        keys.add('i', () => this.toggleSurface());
        keys.add('m', () => this.set({ hasMaximum: !this.layers.hasMaximum }));
        keys.add('w', () => this.toggleSweep());
        keys.add('b', () => this.toggleCrop());
        keys.add('g', () => this.set({ isLit: !this.layers.isLit }));
        keys.add('n', () => this.set({ hasHaze: !this.layers.hasHaze }));
        keys.add('u', () => this.toggleFolded());
        keys.add('Escape', () => this.open(false));
    }

    // -- what they do

    // An address may name what is no moment, before the page has chosen another one.
    private get momentOfVeils(): string {
        const { moment } = this.app.state;
        return isMoment(moment) ? moment : '';
    }
    private get hasFolded(): boolean {
        return veilsFolded(this.layers, this.momentOfVeils);
    }
    private toggleFolded(): void {
        this.set({ hasFolded: toggledFolded(this.layers, this.momentOfVeils) });
    }
    private get layers(): Layers {
        return this.app.state.layers;
    }
    private set(change: Partial<Layers>): void {
        this.app.state.layers = { ...this.layers, ...change };
        this.app.changed();
    }
    private slide(change: Partial<Layers>): void {
        this.drawing.move();
        this.set(change);
    }

    private togglePlane(): void {
        this.set({ planeM: this.layers.planeM === null ? usualPlaneM : null });
    }
    private movePlane(byM: number): void {
        const box = wholeBox(this.app);
        const { planeM } = this.layers;
        if (!box || planeM === null) return;
        this.slide({ planeM: Math.min(box.topM, Math.max(box.bottomM, planeM + byM)) });
    }

    private toggleSection(): void {
        if (this.layers.section) {
            if (this.pointers.current instanceof SectionTool) this.pointers.use(null);
            return this.set({ section: null });
        }
        this.cutAcross();
        this.drawSection();
    }
    private cutAcross(): void {
        const geometry = this.drawing.geometry();
        const section = geometry && acrossView(this.app, geometry);
        if (section) this.set({ section });
    }
    private drawSection(): void {
        this.draw(SectionTool, words.dragSection);
    }
    // Begins a tool, and shows its hint below the picture until it ends.
    private draw(Kind: typeof SectionTool | typeof CropTool, hint: string): void {
        const says = element('tool-says');
        this.pointers.use(
            new Kind(
                this.app,
                this.drawing,
                () => this.pointers.use(null),
                () => says.replaceChildren(),
            ),
        );
        says.textContent = hint;
    }
    // Looks at the section from the side on which A is at the left.
    private lookAtSection(): void {
        const { section } = this.layers;
        const { shown, state } = this.app;
        const whole = wholeBox(this.app);
        if (!section || !shown || !whole) return;
        const plane = planeOf(shown.loaded.grid);
        const [a, b] = section.map((place) => plane.toPlane(place));
        if (!a || !b) return;
        const azimuthDeg = ((Math.atan2(b[0] - a[0], b[1] - a[1]) * 180) / Math.PI + 90 + 360) % 360;
        const heightM = 0.4 * whole.topM;
        this.app.moved({
            ...state.camera,
            azimuthDeg,
            tiltDeg: 80,
            lookAtM: [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), heightM],
        });
    }

    private usualValue(moment: string): number {
        if (moment === 'REF') return usualReflectivity;
        const table = this.app.book?.preset(moment, '');
        return table ? Number((table.bar_begin + 0.75 * (table.end - table.bar_begin)).toFixed(2)) : 0;
    }
    private toggleSurface(): void {
        this.set({
            surface: this.layers.surface ? null : { moment: '', value: this.usualValue(this.app.state.moment) },
        });
    }

    private toggleSweep(): void {
        this.set({ sweepDeg: this.layers.sweepDeg === null ? lowestSweepDeg : null, sweepNumber: null });
    }
    // Pictures take one cut of an elevation in every volume. Names a cut by its number only if it is another one.
    private chooseCut(number: number): void {
        const row = this.drawing.layers.sweepRows()?.find((one) => one.sweep === number);
        if (!row) return;
        this.set({
            sweepDeg: Number(row.elevation_deg.toFixed(2)),
            sweepNumber: isChosen(row, this.app.state.moment) ? null : number,
        });
    }

    private toggleCrop(): void {
        if (this.pointers.current instanceof CropTool) this.pointers.use(null);
        this.set({ crop: this.layers.crop ? null : wholeBox(this.app) });
    }
    private drawCrop(): void {
        this.draw(CropTool, words.dragCrop);
    }
    // Moves a side of the box, but not past the one opposite.
    private slideCrop(side: keyof Crop, value: number): void {
        if (!this.layers.crop) return;
        const crop = { ...this.layers.crop, [side]: value };
        for (const [low, high] of [
            ['westM', 'eastM'],
            ['southM', 'northM'],
            ['bottomM', 'topM'],
        ] as const) {
            const least =
                0.01 *
                (Number(element<HTMLInputElement>(`crop-${high.slice(0, -1)}`).max) -
                    Number(element<HTMLInputElement>(`crop-${low.slice(0, -1)}`).min));
            if (crop[high] - crop[low] < least) {
                if (side === low) crop[low] = crop[high] - least;
                else crop[high] = crop[low] + least;
            }
        }
        this.slide({ crop });
    }

    // -- what they show

    private put(): void {
        const { layers } = this;
        const isOn: Record<string, boolean> = {
            volume: layers.hasVolume,
            plane: layers.planeM !== null,
            section: layers.section !== null,
            surface: layers.surface !== null,
            maximum: layers.hasMaximum,
            sweep: layers.sweepDeg !== null,
            crop: layers.crop !== null,
            light: layers.isLit,
            haze: layers.hasHaze,
            folded: this.hasFolded,
        };
        for (const [name, on] of Object.entries(isOn)) {
            element<HTMLInputElement>(`layer-${name}`).checked = on;
            const more = this.parts.get(name);
            if (more) more.hidden = !on;
        }
        const told = this.drawing.layers.told();
        this.told.textContent = told.join(' · ');
        this.told.hidden = told.length === 0;
        const box = wholeBox(this.app);
        if (!box) return;
        if (layers.planeM !== null) this.putPlane(box, layers.planeM);
        if (layers.section) element<HTMLInputElement>('section-ends').value = sectionText(layers.section);
        if (layers.surface) this.putSurface(layers.surface.value, layers.surface.moment || this.app.state.moment);
        if (layers.sweepDeg !== null) this.putSweep(layers.sweepDeg);
        if (layers.crop) this.putCrop(box, layers.crop);
    }

    private putPlane(box: Crop, heightM: number): void {
        const slider = element<HTMLInputElement>('plane-height');
        const step = Number(slider.step);
        slider.min = String(Math.ceil(box.bottomM / step) * step);
        slider.max = String(Math.floor(box.topM / step) * step);
        slider.value = String(heightM);
        const text = words.planeAt(heightText(heightM, this.app.state.units));
        slider.setAttribute('aria-valuetext', text);
        element('plane-value').textContent = text;
    }

    private putSurface(value: number, moment: string): void {
        putOptions(
            element<HTMLSelectElement>('surface-of'),
            (this.app.domain?.moments ?? []).map((one) => one.moment),
            moment,
        );
        const table = this.app.book?.preset(moment, '');
        const slider = element<HTMLInputElement>('surface-value');
        slider.min = String(table?.bar_begin ?? value);
        slider.max = String(table?.end ?? value);
        slider.step = String(((table?.end ?? 1) - (table?.bar_begin ?? 0)) / 200);
        slider.value = String(value);
        const name = slider.closest('label')!.querySelector('span')!;
        name.textContent = isBelow(moment, value) ? words.enclosesBelow : words.encloses;
        const text = valueText(value, table?.unit ?? '', this.app.state.units);
        slider.setAttribute('aria-valuetext', text);
        element('surface-told').textContent = text;
    }

    private putSweep(elevationDeg: number): void {
        const { layers } = this.drawing;
        const rows = layers.sweepRows() ?? [];
        const cuts = cutsOf(rows, this.app.shown?.moment ?? '');
        const select = element<HTMLSelectElement>('sweep-elevation');
        const textOf = (number: string) =>
            cutText(
                cuts.find((one) => String(one.sweep) === number)!,
                rows,
            );
        if (cuts.length > 0)
            putOptions(
                select,
                cuts.map((one) => String(one.sweep)),
                String(layers.shownCut()?.sweep),
                textOf,
            );
        else putOptions(select, [''], '', () => `${elevationDeg.toFixed(1)}°`);
    }

    private putCrop(box: Crop, crop: Crop): void {
        const { units } = this.app.state;
        for (const side of sides) {
            const slider = element<HTMLInputElement>(`crop-${side.slice(0, -1)}`);
            const isUp = side === 'bottomM' || side === 'topM';
            slider.min = String(isUp ? box.bottomM : side === 'westM' || side === 'eastM' ? box.westM : box.southM);
            slider.max = String(isUp ? box.topM : side === 'westM' || side === 'eastM' ? box.eastM : box.northM);
            slider.step = String((Number(slider.max) - Number(slider.min)) / 200);
            slider.value = String(crop[side]);
            slider.setAttribute(
                'aria-valuetext',
                isUp ? heightText(crop[side], units) : distanceText(crop[side], units),
            );
        }
    }
}
