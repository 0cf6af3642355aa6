// Tells the Nyquist velocity of the shown velocities, and the faults that the radar reported with its volume. Asks for
// these facts while playback rests.

import { valueText } from '../../tables/units';
import { SweepRow, isRegion } from '../../wire/api';
import { isMoment, momentFacts } from '../../wire/moments';
import { App, Shown } from '../app';
import { element, make } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { panelTexts } from '../later_texts';
import { nyquistOf } from '../scan';

const isDoppler = (moment: string): boolean => isMoment(moment) && momentFacts(moment).isDoppler;

export class StationLine {
    private line = make('p', { id: 'station-told', hidden: '' });
    private of: Shown | null = null; // the facts are of this picture
    private rows: SweepRow[] = [];
    private troubles: string[] = [];

    constructor(
        private app: App,
        private drawing: Drawing,
        private facts: FactsOfShown,
    ) {}

    begin(): void {
        element('title').after(this.line);
        this.app.on(['shown', 'time'], () => void this.ask());
        this.app.on(['view', 'units'], () => this.put());
        this.drawing.share.layerCame.push(() => this.put());
        void this.ask();
    }

    private async ask(): Promise<void> {
        const { shown, player } = this.app;
        if (shown === this.of) return;
        [this.of, this.rows, this.troubles] = [null, [], []];
        this.put();
        if (!shown || player.isPlaying || shown.isBetween || isRegion(shown.domain)) return;
        this.of = shown;
        const isOurs = () => this.of === shown;
        const { sites } = shown.loaded.grid;
        // If one of the two answers fails, the line shows only the other.
        const rows =
            isDoppler(shown.moment) && sites.length === 1
                ? this.drawing.share.store.rowsOf(shown, sites[0]!.icao)
                : null;
        const found = await Promise.allSettled([rows, this.facts.ask()]);
        if (!isOurs()) return;
        if (found[0].status === 'fulfilled') this.rows = found[0].value?.rows ?? [];
        if (found[1].status === 'fulfilled') this.troubles = found[1].value.provenance.radar_troubles;
        this.put();
    }

    private put(): void {
        const { app, drawing } = this;
        const cut = app.state.layers.sweepDeg === null ? null : drawing.layers.shownCut();
        const moment = this.of?.moment ?? '';
        const speeds = isDoppler(moment) ? nyquistOf(cut ? [cut] : this.rows, moment) : null;
        const { units } = app.state;
        const nyquist =
            speeds && panelTexts.nyquist(...(speeds.map((mps) => valueText(mps, 'm/s', units, 1)) as [string, string]));
        const troubles = this.troubles.map((one) => make('b', {}, panelTexts.reported(one)));
        const parts = [...(nyquist ? [nyquist] : []), ...troubles];
        this.line.replaceChildren(...parts.flatMap((part, i) => (i > 0 ? [' · ', part] : [part])));
        this.line.hidden = parts.length === 0;
    }
}
