// What is under the pointer, beside it: value, height, beam, age and stated error.

import { beamReading } from '../../fields/beam_reading';
import { distanceText, heightText, shownUnit, valueText } from '../../tables/units';
import { App } from '../app';
import { element, paragraph } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { Picked, pick } from '../picked';
import { texts } from '../texts';

const restsAfterMs = 120;
const mostDigits = 6;
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
        if (!picked || (picked.value === null && picked.groundCode === null)) return;
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

    private lines(picked: Picked): string[] {
        const { units } = this.app.state;
        if (picked.value === null) return [texts.hover.ground(this.statusText(picked.groundCode!))];
        const lines = [texts.hover.value(valueText(picked.value, this.app.unit, units, mostDigits), heightText(picked.heightM, units))];
        if (picked.halvings > 0) lines.push(texts.hover.greatestOf(picked.halvings));
        const { grid } = this.app.shown!.loaded;
        const { known } = this.facts;
        const beam = beamReading(grid.sites, known, picked.place, picked.heightM);
        if (!beam) return lines;
        const elevation = (beam.sweepDeg ?? beam.elevationDeg).toFixed(1);
        lines.push(texts.hover.beam(elevation, distanceText(beam.widthM, units), distanceText(beam.rangeM, units), beam.icao));
        const site = this.facts.sites?.find(one => one.site === beam.icao);
        const timeMs = beam.timeMs ?? grid.timeMs;
        const ageS = (Date.now() - timeMs) / 1000;
        if (site) lines.push(texts.start.ofVolumes(site.volumes.map(one => one.middle_s)));
        else lines.push(ageS < liveS ? texts.start.age(ageS) : texts.hover.time(new Date(timeMs).toISOString().slice(11, 19)));
        if (beam.rms !== null) {
            const unit = known!.audit!.unit;
            const { perStored, symbol } = shownUnit(unit, units);
            lines.push(texts.hover.error(`${(beam.rms * perStored).toFixed(1)} ${symbol}`));
        }
        return lines;
    }

    private statusText(code: number): string {
        return [texts.notSeen, texts.noEcho, texts.rangeFolded][code] ?? texts.hover.hidden;
    }
}
