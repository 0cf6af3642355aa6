// Shows a box beside the pointer. It tells value, height, beam, time and stated error of what is under the pointer.

import { beamReading, beamWidthM, nearestTo } from '../../fields/beam_reading';
import { GateHit } from '../../scene/solid_hits';
import { distanceText, heightText, shownUnit, valueText } from '../../tables/units';
import { isRegion } from '../../wire/api';
import { CellState } from '../../wire/packed_grid';
import { App } from '../app';
import { element, paragraph, pixelRatio } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { Picked, pick } from '../picked';
import { panelTexts } from '../later_texts';
import { stateText, texts } from '../texts';

const restsAfterMs = 120;
const mostDigits = 6; // decimals of a stored value
const mixedDigits = 1; // decimals of a value that is mixed from several cells

export class Hover {
    private timer = 0;
    private at: [number, number] | null = null;

    constructor(
        private app: App,
        private drawing: Drawing,
        private facts: FactsOfShown,
    ) {}

    begin(): void {
        this.app.on(['choices', 'camera', 'map'], () => this.hide());
        // Read each new picture, so that the box always describes the drawn picture.
        this.drawing.pictureChanged.push(() => this.timer === 0 && this.put());
        this.drawing.picture.addEventListener('pointerleave', () => this.hide());
        this.drawing.picture.addEventListener('pointerdown', () => this.hide());
        window.addEventListener('resize', () => this.hide());
    }

    // Call when the pointer moves over the picture. Shows the box once the pointer rests.
    over(x: number, y: number): void {
        this.hide();
        this.at = [x, y];
        this.timer = window.setTimeout(() => {
            this.timer = 0;
            this.put();
        }, restsAfterMs);
    }

    hide(): void {
        window.clearTimeout(this.timer);
        this.timer = 0;
        this.at = null;
        element('hover').hidden = true;
    }

    private put(): void {
        if (!this.at) return;
        const picked = this.app.isGraphicsLost ? null : pick(this.app, this.drawing, ...this.at, true);
        const box = element('hover');
        box.hidden = !picked || picked.lacksCells || (picked.state === null && picked.layer !== 'outside');
        if (!picked || box.hidden) return;
        this.whenTold(() => this.put());
        box.replaceChildren(...this.lines(picked).map(paragraph));
        const [x, y] = this.at.map((one) => one / pixelRatio()) as [number, number];
        const { width, height } = box.getBoundingClientRect();
        box.style.left = `${Math.max(4, x + 14 + width < window.innerWidth ? x + 14 : x - 14 - width)}px`;
        box.style.top = `${Math.max(4, y + 14 + height < window.innerHeight ? y + 14 : y - 14 - height)}px`;
    }

    // Calls `again` once the facts for beam, time and error have come. Does not call `again` if the facts are here
    // already, or cannot be loaded.
    whenTold(again: () => void): void {
        const isRegional = isRegion(this.app.shown?.domain ?? '');
        if (isRegional ? this.facts.sites : this.facts.known) return;
        (isRegional ? this.facts.askSites() : this.facts.ask()).then(again, () => undefined);
    }

    // Returns the lines about a place: value, layer, beam, time and stated error.
    lines(picked: Picked): string[] {
        const { app } = this;
        const { units } = app.state;
        const words = panelTexts.hover;
        const { layer, state, value, heightM, gate } = picked;
        const way = nearestTo(app.shown?.loaded.grid.sites ?? [], picked.place);
        const from = way
            ? [words.from(distanceText(way.way.distanceM, units), (way.way.azimuth * 180) / Math.PI, way.site.icao)]
            : [];
        if (layer === 'outside') return [words.outside, ...from];
        const told =
            state === CellState.value
                ? valueText(
                      value,
                      app.unit,
                      units,
                      layer === 'plane' || layer === 'section' || layer === 'maximum' ? mixedDigits : mostDigits,
                  )
                : stateText(state ?? CellState.notSeen);
        if (layer === 'ground')
            return [
                state === CellState.value ? words.hidden(told, this.isBelowShown(value)) : words.ground(told),
                ...from,
            ];
        // Give no height for range folded air, because the ray may cross such air at many heights.
        if (layer === 'volume' && state !== CellState.value) return [told, ...from];
        // Give the height of a column maximum only if there is a value and the cells are not halved.
        const isAtOne = layer !== 'maximum' || (picked.halvings === 0 && state === CellState.value);
        const lines = [isAtOne ? words.value(told, heightText(heightM, units)) : told];
        if (state === CellState.ambiguous) lines.push(texts.ambiguousTold);
        if (layer !== 'volume' && layer !== 'sweep') lines.push(words.layers[layer]);
        if (picked.halvings > 0) lines.push(words.greatestOf(picked.halvings));
        if (gate) return [...lines, ...this.gateLines(gate)];
        return [...lines, ...(isAtOne && state === CellState.value ? this.beamLines(picked, from) : from)];
    }

    // Returns true if a value is below the shown range, rather than too transparent to see.
    private isBelowShown(value: number): boolean {
        const { state, shownTable: table } = this.app;
        return value < Math.max(state.least ?? -Infinity, table?.bar_begin ?? -Infinity);
    }

    // Returns the time of day. It is not an age, because the text may stay on the page.
    private when(timeMs: number): string {
        return panelTexts.hover.time(new Date(timeMs).toISOString().slice(11, 19));
    }

    private gateLines({ station, elevationDeg, rangeM, azimuthDeg, timeMs, state }: GateHit): string[] {
        const { units } = this.app.state;
        const beam = panelTexts.hover.beam(
            elevationDeg.toFixed(1),
            distanceText(beamWidthM(station, rangeM), units),
            distanceText(rangeM, units),
            azimuthDeg,
            station,
        );
        return state === CellState.notSeen ? [beam] : [beam, this.when(timeMs)];
    }

    // Returns the lines about the beam. If the facts list no sweeps, it is unknown whether any beam had this elevation.
    // The lines then have `from`, the way from the site, instead of the beam.
    private beamLines(picked: Picked, from: string[]): string[] {
        const { units } = this.app.state;
        const { known } = this.facts;
        const beam = beamReading(this.app.shown?.loaded.grid.sites ?? [], known, picked.place, picked.heightM);
        if (!beam) return [];
        const told = (sweepDeg: number) =>
            panelTexts.hover.beam(
                sweepDeg.toFixed(1),
                distanceText(beam.widthM, units),
                distanceText(beam.rangeM, units),
                beam.azimuthDeg,
                beam.icao,
            );
        const lines = beam.sweepDeg === null ? from : [told(beam.sweepDeg)];
        const site = this.facts.sites?.sites.find((one) => one.site === beam.icao);
        if (site) lines.push(texts.start.ofVolumes(site.volumes.map((one) => one.middle_s)));
        else if (beam.timeMs !== null) lines.push(this.when(beam.timeMs));
        if (beam.rms !== null) {
            const { perStored, symbol } = shownUnit(known?.audit?.unit ?? '', units);
            lines.push(panelTexts.hover.error(`${(beam.rms * perStored).toFixed(1)} ${symbol}`));
        }
        return lines;
    }
}
