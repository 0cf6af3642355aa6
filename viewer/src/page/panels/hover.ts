// What is under the pointer, beside it: value, height, beam, age and stated error.

import { beamReading, beamWidthM } from '../../fields/beam_reading';
import { GateHit } from '../../scene/solid_hits';
import { distanceText, heightText, shownUnit, valueText } from '../../tables/units';
import { CellState } from '../../wire/packed_grid';
import { App } from '../app';
import { element, paragraph } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { Picked, pick } from '../picked';
import { texts } from '../texts';

const restsAfterMs = 120;
const mostDigits = 6; // of a value that is stored
const mixedDigits = 1; // of one between others
const liveS = 24 * 3600; // older volumes have a time instead of an age

export class Hover {
    private timer = 0;
    private at: [number, number] | null = null;

    constructor(
        private app: App,
        private drawing: Drawing,
        private facts: FactsOfShown,
    ) {}

    begin(): void {
        for (const happening of ['choices', 'camera', 'map'] as const) this.app.on(happening, () => this.hide());
        for (const happening of ['shown', 'cells'] as const) this.app.on(happening, () => this.put());
        this.drawing.picture.addEventListener('pointerleave', () => this.hide());
        this.drawing.picture.addEventListener('pointerdown', () => this.hide());
    }

    // The pointer rests over a pixel of the picture.
    over(x: number, y: number): void {
        this.hide();
        this.at = [x, y];
        this.timer = window.setTimeout(() => this.put(), restsAfterMs);
    }

    hide(): void {
        window.clearTimeout(this.timer);
        this.at = null;
        element('hover').hidden = true;
    }

    private put(): void {
        if (!this.at) return;
        const picked = pick(this.app, this.drawing, ...this.at, true);
        if (!picked || picked.state === null && picked.layer !== 'outside') return;
        // The beam and the error come once the server has told them.
        if (!this.facts.known) this.facts.ask().then(() => this.put(), () => undefined);
        const box = element('hover');
        box.replaceChildren(...this.lines(picked).map(paragraph));
        box.hidden = false;
        const ratio = window.devicePixelRatio || 1;
        const [x, y] = [this.at[0] / ratio, this.at[1] / ratio];
        const { width, height } = box.getBoundingClientRect();
        box.style.left = `${Math.max(4, x + 14 + width < window.innerWidth ? x + 14 : x - 14 - width)}px`;
        box.style.top = `${Math.max(4, y + 14 + height < window.innerHeight ? y + 14 : y - 14 - height)}px`;
    }

    // What is told of a place: its value, from which layer, which beam saw it and when, and the stated error.
    lines(picked: Picked): string[] {
        const { app } = this;
        const { units } = app.state;
        const words = texts.hover;
        const { layer, state, value, heightM, gate } = picked;
        if (layer === 'outside') return [words.outside];
        const told = state === CellState.value ? valueText(value, app.unit, units, layer === 'plane' || layer === 'section' || layer === 'maximum' ? mixedDigits : mostDigits) : [texts.notSeen, texts.noEcho, texts.rangeFolded][state ?? 0]!;
        if (layer === 'ground') return [state === CellState.value ? words.hidden(told) : words.ground(told)];
        // Air that is range folded all along the ray has no one height.
        if (layer === 'volume' && state !== CellState.value) return [told];
        const lines = [words.value(told, heightText(heightM, units))];
        if (layer !== 'volume' && layer !== 'sweep') lines.push(words.layers[layer]);
        if (picked.halvings > 0) lines.push(words.greatestOf(picked.halvings));
        if (gate) return [...lines, ...this.gateLines(gate)];
        return state === CellState.value ? [...lines, ...this.beamLines(picked)] : lines;
    }

    private when(timeMs: number): string {
        const ageS = (Date.now() - timeMs) / 1000;
        return ageS >= 0 && ageS < liveS ? texts.start.age(ageS) : texts.hover.time(new Date(timeMs).toISOString().slice(11, 19));
    }

    private gateLines({ elevationDeg, rangeM, azimuthDeg, timeMs }: GateHit): string[] {
        const { units } = this.app.state;
        const station = this.drawing.layers!.sweepStation();
        const beam = texts.hover.beam(elevationDeg.toFixed(1), distanceText(beamWidthM(rangeM), units), distanceText(rangeM, units), azimuthDeg, station);
        return [beam, this.when(timeMs)];
    }

    private beamLines(picked: Picked): string[] {
        const { units } = this.app.state;
        const { grid } = this.app.shown!.loaded;
        const { known } = this.facts;
        const beam = beamReading(grid.sites, known, picked.place, picked.heightM);
        if (!beam) return [];
        const elevation = (beam.sweepDeg ?? beam.elevationDeg).toFixed(1);
        const lines = [texts.hover.beam(elevation, distanceText(beam.widthM, units), distanceText(beam.rangeM, units), beam.azimuthDeg, beam.icao)];
        const site = this.facts.sites?.find(one => one.site === beam.icao);
        lines.push(site ? texts.start.ofVolumes(site.volumes.map(one => one.middle_s)) : this.when(beam.timeMs ?? grid.timeMs));
        if (beam.rms !== null) {
            const unit = known!.audit!.unit;
            const { perStored, symbol } = shownUnit(unit, units);
            lines.push(texts.hover.error(`${(beam.rms * perStored).toFixed(1)} ${symbol}`));
        }
        return lines;
    }
}
