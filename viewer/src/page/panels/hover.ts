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
import { Pane } from '../pane';
import { Picked, pick } from '../picked';
import { panelTexts } from '../later_texts';
import { stateText, texts } from '../texts';
import { PaneHeads } from './pane_heads';

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
        private heads: PaneHeads,
    ) {}

    begin(): void {
        this.app.on(['camera', 'map'], () => this.hide());
        // Keep the box while only the list of domains or moments changes, for example when a radar sends a volume.
        this.app.on('choices', () => this.app.shown?.domain !== this.app.state.domain && this.hide());
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
        this.heads.point(this.at, this.drawing.pointed, () => '');
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
        this.heads.hidePointer();
    }

    // Returns the pane under the pointer.
    private get pane(): Pane {
        return this.drawing.panes[this.drawing.pointed] ?? this.drawing.pane;
    }

    private put(): void {
        if (!this.at) return;
        const { at, drawing, pane } = this;
        const picked = this.app.isGraphicsLost ? null : pick(drawing, ...at, true, pane);
        if (!this.app.isGraphicsLost && drawing.panes.length > 1)
            this.heads.point(at, pane.index, (other) => this.valueIn(other, at));
        const box = element('hover');
        box.hidden = !picked || picked.lacksCells || (picked.state === null && picked.layer !== 'outside');
        if (!picked || box.hidden) return;
        this.whenTold(() => this.put());
        box.replaceChildren(...[...this.lines(picked, pane), ...this.linesOfOthers(at, pane)].map(paragraph));
        const { left, top } = drawing.picture.getBoundingClientRect();
        const place = drawing.places[pane.index]!;
        const x = left + (at[0] + place.left) / pixelRatio();
        const y = top + (at[1] + place.top) / pixelRatio();
        const { width, height } = box.getBoundingClientRect();
        box.style.left = `${Math.max(4, x + 14 + width < window.innerWidth ? x + 14 : x - 14 - width)}px`;
        box.style.top = `${Math.max(4, y + 14 + height < window.innerHeight ? y + 14 : y - 14 - height)}px`;
    }

    // Returns the lines with the values of the other panes at a pixel.
    linesOfOthers(at: [number, number], pane = this.drawing.pane): string[] {
        return this.drawing.panes
            .filter((other) => other !== pane)
            .map((other) => this.valueIn(other, at))
            .filter(Boolean);
    }
    // Returns the moment and the value of a pane at a pixel; an empty text if it shows neither echo nor clear
    // air there.
    private valueIn(pane: Pane, at: [number, number]): string {
        const picked = pick(this.drawing, ...at, true, pane);
        if (!picked || picked.lacksCells || picked.state === null) return '';
        return this.told(picked, pane);
    }

    // Calls `again` once the facts for beam, time and error have come. Does not call `again` if the facts are here
    // already, or cannot be loaded.
    whenTold(again: () => void): void {
        const isRegional = isRegion(this.app.shown?.domain ?? '');
        if (isRegional ? this.facts.sites : this.facts.known) return;
        (isRegional ? this.facts.askSites() : this.facts.ask()).then(again, () => undefined);
    }

    // Returns the value under the pointer, with the moment if there are several panes.
    private told({ layer, state, value }: Picked, { unit, state: { units }, shown }: Pane): string {
        const isMixed = layer === 'plane' || layer === 'section' || layer === 'maximum';
        const told =
            state === CellState.value
                ? valueText(value, unit, units, isMixed ? mixedDigits : mostDigits)
                : stateText(state ?? CellState.notSeen);
        return this.drawing.panes.length > 1 ? `${shown?.moment ?? ''} ${told}` : told;
    }

    // Returns the lines about a place of a pane: value, layer, beam, time and stated error.
    lines(picked: Picked, pane = this.drawing.pane): string[] {
        const { units } = pane.state;
        const words = panelTexts.hover;
        const { layer, state, value, heightM, gate } = picked;
        const way = nearestTo(pane.shown?.loaded.grid.sites ?? [], picked.place);
        const from = way
            ? [words.from(distanceText(way.way.distanceM, units), (way.way.azimuth * 180) / Math.PI, way.site.icao)]
            : [];
        if (layer === 'outside') return [words.outside, ...from];
        const told = this.told(picked, pane);
        if (layer === 'ground')
            return [
                state === CellState.value ? words.hidden(told, isBelowShown(pane, value)) : words.ground(told),
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
        return [...lines, ...(isAtOne && state === CellState.value ? this.beamLines(picked, pane, from) : from)];
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
    private beamLines(picked: Picked, pane: Pane, from: string[]): string[] {
        const { units } = pane.state;
        // The facts are those of the active pane.
        const known = pane.isActive ? this.facts.known : null;
        const beam = beamReading(pane.shown?.loaded.grid.sites ?? [], known, picked.place, picked.heightM);
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

// Returns true if a value is below the shown range, rather than too transparent to see.
function isBelowShown({ state, shownTable: table }: Pane, value: number): boolean {
    return value < Math.max(state.least ?? -Infinity, table?.bar_begin ?? -Infinity);
}
