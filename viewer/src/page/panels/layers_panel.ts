// Shows the panel of layers. Each layer has a checkbox and a key, and controls while it is on.

import {
    Crop,
    Layers,
    isBelow,
    lowestTiltDeg,
    sectionOf,
    sectionText,
    toggledFolded,
    veilsFolded,
} from '../../scene/layers';
import { legOf } from '../../earth/measure';
import { Place, planeOf } from '../../earth/projection';
import { distanceText, heightText, valueText } from '../../tables/units';
import { App } from '../app';
import { button, element, labeled, leaveByEscape, make, putOptions } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { CropTool, SectionGrip, SectionTool, acrossView, addMarks, fromRadar, wholeBox } from '../layer_tools';
import { Pointers } from '../pointers';
import { derivedOf, isMoment } from '../../wire/moments';
import { layerTexts } from '../later_texts';
import { texts } from '../texts';
import { openSettings } from './look';
import { listenToCuts, putCuts } from './tilts';

const words = layerTexts;
const usualPlaneM = 3000;
const planeStepM = 500;
const usualReflectivity = 45;
const axes = [
    ['westM', 'eastM'],
    ['southM', 'northM'],
    ['bottomM', 'topM'],
] as const;
const sides = axes.flat();
const cropSliderId = (side: keyof Crop): string => `crop-${side.slice(0, -1)}`;

// Sets range, step and value of a slider. Screen readers read the text.
function putSlider(id: string, [low, high]: [number, number], step: number, value: number, text: string): void {
    const slider = element<HTMLInputElement>(id);
    slider.min = String(low);
    slider.max = String(high);
    slider.step = String(step);
    slider.value = String(value); // set after the range, because a browser limits the value to the range
    slider.setAttribute('aria-valuetext', text);
}

type ToggleName =
    | 'volume'
    | 'plane'
    | 'section'
    | 'surface'
    | 'maximum'
    | 'sweep'
    | 'glyphs'
    | 'rotation'
    | 'cells'
    | 'crop'
    | 'light'
    | 'haze'
    | 'folded';
interface Toggle {
    box: HTMLInputElement;
    isOn: () => boolean;
    more: HTMLElement | null; // controls that are visible while the layer is on
}

export class LayersPanel {
    private box = make('section', { id: 'layers', hidden: '', 'aria-label': texts.layers.title });
    private toggles: Toggle[] = [];

    constructor(
        private app: App,
        private drawing: Drawing,
        private pointers: Pointers,
    ) {}

    begin(keys: Keys): void {
        element('settings').after(this.box);
        leaveByEscape(this.box, 'layers-open', () => this.open(false));
        element('layers-open').addEventListener('click', () => this.open(this.box.hidden));
        element('open').addEventListener('click', () => this.open(false));
        this.addLayers(keys);
        addMarks(this.drawing);
        this.pointers.setGrip(new SectionGrip(this.app, this.drawing));
        this.app.on(['view', 'shown', 'choices', 'units'], () => this.put());
        this.drawing.share.layerCame.push(() => this.put());
        this.put();
    }

    private open(isOpen: boolean): void {
        if (isOpen) openSettings(this.drawing, false);
        this.box.hidden = !isOpen;
        element('layers-open').setAttribute('aria-expanded', String(isOpen));
        this.put();
        this.drawing.draw();
    }

    // -- the controls

    // Adds a checkbox and a key for each layer.
    private addLayers(keys: Keys): void {
        const add = (name: ToggleName, key: string, isOn: () => boolean, toggle: () => void, parts?: HTMLElement[]) => {
            this.addToggle(name, isOn, toggle, parts);
            keys.add(key, toggle);
        };
        const addFlag = (
            name: ToggleName,
            key: string,
            flag: 'hasVolume' | 'hasMaximum' | 'hasRotation' | 'hasCells' | 'isLit' | 'hasHaze',
        ) =>
            add(
                name,
                key,
                () => this.layers[flag],
                () => this.set({ [flag]: !this.layers[flag] }),
            );
        const is = (layer: 'planeM' | 'section' | 'surface' | 'sweepDeg' | 'crop') => () => this.layers[layer] !== null;
        addFlag('volume', 'v', 'hasVolume');
        add('plane', 'c', is('planeM'), () => this.togglePlane(), this.planeParts());
        add('section', 'x', is('section'), () => this.toggleSection(), this.sectionParts());
        add('surface', 'i', is('surface'), () => this.toggleSurface(), this.surfaceParts());
        addFlag('maximum', 'm', 'hasMaximum');
        add('sweep', 'w', is('sweepDeg'), () => this.toggleSweep(), this.sweepParts());
        add(
            'glyphs',
            'j',
            () => this.layers.hasGlyphs,
            () => this.toggleGlyphs(),
        );
        addFlag('rotation', 'k', 'hasRotation');
        addFlag('cells', 'y', 'hasCells');
        add('crop', 'b', is('crop'), () => this.toggleCrop(), this.cropParts());
        addFlag('light', 'g', 'isLit');
        addFlag('haze', 'n', 'hasHaze');
        add(
            'folded',
            'u',
            () => this.hasFolded,
            () => this.toggleFolded(),
        );
        keys.add('[', () => this.movePlane(-planeStepM));
        keys.add(']', () => this.movePlane(planeStepM));
        keys.add('a', () => this.lookAtSection());
        keys.add('Escape', () => this.open(false));
    }

    private addToggle(name: ToggleName, isOn: () => boolean, toggle: () => void, parts?: HTMLElement[]): void {
        const box = make('input', { id: `layer-${name}`, type: 'checkbox' });
        box.addEventListener('change', toggle);
        const label = labeled(words[name], box);
        label.className = 'toggle';
        const more = parts ? make('div', {}, ...parts) : null;
        this.toggles.push({ box, isOn, more });
        this.box.append(label, ...(more ? [more] : []));
    }
    private slider(id: string, take: (value: number) => void): HTMLInputElement {
        const slider = make('input', { id, type: 'range' });
        slider.addEventListener('input', () => take(Number(slider.value)));
        return slider;
    }

    private planeParts(): HTMLElement[] {
        const height = this.slider('plane-height', (planeM) => this.slide({ planeM }));
        height.setAttribute('aria-label', words.plane);
        return [height, make('output', { id: 'plane-value' })];
    }

    private sectionParts(): HTMLElement[] {
        const ends = make('input', { id: 'section-ends', type: 'text' });
        ends.addEventListener('change', () => {
            const section = sectionOf(ends.value);
            if (section) this.set({ section });
            else this.put();
        });
        return [
            button('section-draw', words.draw, () => this.drawSection()),
            button('section-across', words.across, () => this.cutAcross()),
            button('section-radar', words.fromRadar, () => this.cutFromRadar()),
            button('section-look', words.lookAt, () => this.lookAtSection()),
            labeled(words.ends, ends),
            make('output', { id: 'section-told' }),
        ];
    }

    private surfaceParts(): HTMLElement[] {
        const slider = this.slider('surface-value', (value) => {
            const { surface } = this.layers;
            if (surface) this.slide({ surface: { ...surface, value } });
        });
        const of = make('select', { id: 'surface-of' });
        of.addEventListener('change', () => {
            const moment = of.value === this.app.state.moment ? '' : of.value;
            this.set({ surface: { moment, value: this.usualValue(of.value) } });
        });
        return [labeled(words.encloses, slider, make('output', { id: 'surface-told' })), labeled(words.surfaceOf, of)];
    }

    private sweepParts(): HTMLElement[] {
        const elevation = make('select', { id: 'sweep-elevation' });
        listenToCuts(this.app, this.drawing, elevation);
        const flag = (id: string, text: string, name: 'isSweepDealiased' | 'isSweepWeather') => {
            const box = make('input', { id, type: 'checkbox' });
            box.addEventListener('change', () => this.set({ [name]: box.checked }));
            const label = labeled(text, box);
            label.className = 'toggle';
            return label;
        };
        return [
            labeled(words.elevation, elevation),
            flag('sweep-dealiased', words.dealiasSweep, 'isSweepDealiased'),
            flag('sweep-weather', words.weatherSweep, 'isSweepWeather'),
        ];
    }

    private cropParts(): HTMLElement[] {
        const sliders = sides.map((side) =>
            labeled(
                words.sides[side],
                this.slider(cropSliderId(side), (value) => this.slideCrop(side, value)),
                make('output', { id: `${cropSliderId(side)}-value` }),
            ),
        );
        return [button('crop-draw', words.draw, () => this.drawCrop()), ...sliders];
    }

    // -- actions

    // Returns the chosen moment; an empty text if the page does not know it.
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
    private cutFromRadar(): void {
        const { section } = this.layers;
        const radial = section && fromRadar(this.app, section);
        if (radial) this.set({ section: radial });
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
    // Turns the camera so that it looks at the section from the side, with the section's end A at the left.
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
        this.set({ sweepDeg: this.layers.sweepDeg === null ? lowestTiltDeg : null, sweepNumber: null });
    }
    // Turns glyphs on or off. Glyphs need a sweep, so turning them on also shows a sweep.
    private toggleGlyphs(): void {
        const { hasGlyphs, sweepDeg } = this.layers;
        this.set({ hasGlyphs: !hasGlyphs, sweepDeg: hasGlyphs ? sweepDeg : (sweepDeg ?? lowestTiltDeg) });
    }

    private toggleCrop(): void {
        if (this.layers.crop) {
            if (this.pointers.current instanceof CropTool) this.pointers.use(null);
            return this.set({ crop: null });
        }
        this.set({ crop: wholeBox(this.app) });
        this.drawCrop();
    }
    private drawCrop(): void {
        this.draw(CropTool, words.dragCrop);
    }
    // Moves a side of the box. Keeps a distance of at least a hundredth of the grid's extent to the opposite side.
    private slideCrop(side: keyof Crop, value: number): void {
        const box = wholeBox(this.app);
        if (!this.layers.crop || !box) return;
        const crop = { ...this.layers.crop, [side]: value };
        for (const [low, high] of axes) {
            const least = 0.01 * (box[high] - box[low]);
            if (crop[high] - crop[low] >= least) continue;
            if (side === low) crop[low] = crop[high] - least;
            else crop[high] = crop[low] + least;
        }
        this.slide({ crop });
    }

    // -- state of the controls

    private put(): void {
        const { layers } = this;
        for (const { box, isOn, more } of this.toggles) {
            box.checked = isOn();
            if (more) more.hidden = !box.checked;
        }
        const box = wholeBox(this.app);
        if (!box) return;
        if (layers.planeM !== null) this.putPlane(box, layers.planeM);
        if (layers.section) this.putSection(layers.section);
        if (layers.surface) this.putSurface(layers.surface.value, layers.surface.moment || this.app.state.moment);
        if (layers.sweepDeg !== null) this.putSweep();
        if (layers.crop) this.putCrop(box, layers.crop);
    }

    private putSection(section: readonly [Place, Place]): void {
        element<HTMLInputElement>('section-ends').value = sectionText(section);
        const { distanceM, azimuthDeg } = legOf(...section);
        const length = distanceText(distanceM, this.app.state.units);
        element('section-told').textContent = words.sectionTold(length, Math.round(azimuthDeg) % 360);
    }

    private putPlane(box: Crop, heightM: number): void {
        const step = planeStepM / 5;
        const range: [number, number] = [Math.ceil(box.bottomM / step) * step, Math.floor(box.topM / step) * step];
        const text = words.planeAt(heightText(heightM, this.app.state.units));
        putSlider('plane-height', range, step, heightM, text);
        element('plane-value').textContent = text;
    }

    private putSurface(value: number, moment: string): void {
        putOptions(
            element<HTMLSelectElement>('surface-of'),
            (this.app.domain?.moments ?? []).map((one) => one.moment),
            moment,
        );
        const table = this.app.book?.preset(moment, '');
        const name = element('surface-value').closest('label')!.querySelector('span')!;
        name.textContent = isBelow(moment, value) ? words.enclosesBelow : words.encloses;
        const text = valueText(value, table?.unit ?? '', this.app.state.units);
        const range: [number, number] = table ? [table.bar_begin, table.end] : [value, value];
        putSlider('surface-value', range, (range[1] - range[0]) / 200, value, text);
        element('surface-told').textContent = text;
    }

    private putSweep(): void {
        const shown = this.app.shown?.moment ?? '';
        const dealiased = element<HTMLInputElement>('sweep-dealiased');
        dealiased.checked = this.layers.isSweepDealiased;
        dealiased.closest('label')!.hidden = derivedOf(shown) === null;
        element<HTMLInputElement>('sweep-weather').checked = this.layers.isSweepWeather;
        putCuts(this.app, this.drawing, element('sweep-elevation'));
    }

    private putCrop(box: Crop, crop: Crop): void {
        const { units } = this.app.state;
        for (const axis of axes) {
            const [low, high] = [box[axis[0]], box[axis[1]]];
            for (const side of axis) {
                const text = axis[1] === 'topM' ? heightText(crop[side], units) : distanceText(crop[side], units);
                putSlider(cropSliderId(side), [low, high], (high - low) / 200, crop[side], text);
                element(`${cropSliderId(side)}-value`).textContent = text;
            }
        }
    }
}
