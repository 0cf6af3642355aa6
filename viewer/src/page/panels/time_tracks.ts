// Draws tracks below the slider of times: times of day, volumes with their scan patterns, and the cuts of the shown
// volume. A press on a box shows its volume, or its cut in 2D.

import { Run, labeledOf, runsOf, shareOf } from '../../time/marks';
import { SweepRow, VolumeAt, isRegion, volumesBetween } from '../../wire/api';
import { App, Shown } from '../app';
import { Clock } from '../clock';
import { button, element, labeledButton, make, textScale } from '../dom';
import { Drawing } from '../drawing';
import { panelTexts } from '../later_texts';
import { measuredOf, waveformOf } from '../scan';
import { cutButton } from './tilts';

const words = panelTexts.tracks;
const mostBoxes = 300; // of volumes; more would be too narrow to press
const labelPx = 48; // room for a time of day
const datedPx = 96; // room for a date and a time of day
const patternPx = 22; // least width of a box with the number of its pattern
const wordedPx = 58; // least width of a box that also has the word for its pattern
const sameVolumeMs = 15_000; // the time of a grid and of its volume differ a little

export class TimeTracks {
    private clock = new Clock();
    private slider = element<HTMLInputElement>('times');
    private labels = make('div', { id: 'time-labels', 'aria-hidden': 'true' });
    private volumes = make('div', { id: 'volume-track', 'aria-hidden': 'true' });
    // The time of the volume whose cuts are shown, because cuts are not placed by the times above them.
    private cutsName = make('span', { class: 'track-name', title: words.cuts });
    private cuts = make('div', { id: 'cut-track', role: 'group', 'aria-label': words.cuts });
    private zone = labeledButton('clock', '', '', () => this.toggleClock());
    private known: VolumeAt[] = [];
    private askedFor: string[] | null = null; // times for which the volumes were asked
    private boxes: { run: Run; box: HTMLElement }[] = [];
    private puts: (() => void)[] = []; // press the button of the shown cut
    private madeOf: unknown[] = [];
    private cutsOf: Shown | null = null;

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    begin(): void {
        element('track').append(
            this.zone,
            make('span', { class: 'track-name' }, words.volumes),
            this.cutsName,
            this.labels,
            this.volumes,
            this.cuts,
        );
        this.cuts.addEventListener('keydown', (event) => this.stepFocus(event));
        const { app } = this;
        app.on(['time', 'shown', 'choices'], () => this.put());
        app.on('shown', () => void this.putCuts());
        app.on('view', () => this.putShownCut());
        app.on('time', () => !app.player.isPlaying && this.cutsOf !== app.shown && void this.putCuts());
        this.drawing.share.layerCame.push(() => this.putShownCut());
        new ResizeObserver(() => this.put()).observe(this.slider);
        this.put();
        void this.putCuts();
    }

    private toggleClock(): void {
        this.clock.toggle();
        this.put();
        this.cutsOf = null;
        void this.putCuts();
    }

    private put(): void {
        const { app, clock } = this;
        void this.ask();
        const { times } = app.player;
        const width = this.slider.clientWidth;
        const of = [times, width, this.known, clock.isLocal];
        if (of.some((part, i) => part !== this.madeOf[i])) {
            this.madeOf = of;
            this.putLabels(times, width);
            this.putVolumes(times, width);
        }
        const at = app.shown ? times.indexOf(app.shown.time) : app.player.at;
        for (const { run, box } of this.boxes) box.classList.toggle('shown', at >= run.from && at <= run.to);
    }

    // Asks for the volumes of the timeline's times.
    private async ask(): Promise<void> {
        const { app } = this;
        const { stored } = app.timeline;
        if (this.askedFor === stored || stored.length === 0) return;
        const isSame = this.askedFor?.[0] === stored[0] && this.askedFor?.length === stored.length;
        this.askedFor = stored;
        const site = app.state.domain;
        if (!isSame) this.known = [];
        if (isRegion(site) || !/^[A-Z][A-Z0-9]{3}$/.test(site)) return;
        const shifted = (time: string, byMs: number) => new Date(Date.parse(time) + byMs).toISOString();
        try {
            const found = await volumesBetween(
                site,
                shifted(stored[0]!, -sameVolumeMs),
                shifted(stored[stored.length - 1]!, sameVolumeMs),
            );
            if (this.askedFor !== stored) return;
            this.known = found;
            this.put();
        } catch {
            // The boxes then lack their patterns. A later list of times asks again.
        }
    }

    private putLabels(times: string[], width: number): void {
        const { clock } = this;
        const days = times.map((time) => clock.day(Date.parse(time)));
        const isDated = days[0] !== days[days.length - 1];
        const room = Math.floor(width / ((isDated ? datedPx : labelPx) * textScale()));
        let day = isDated ? '' : days[0];
        const labels = labeledOf(times.length, room).map((index) => {
            const timeMs = Date.parse(times[index]!);
            const text = [days[index] === day ? '' : days[index], clock.minute(timeMs)].filter(Boolean).join(' ');
            day = days[index];
            return this.placed(make('span', {}, text), index, times.length);
        });
        this.labels.replaceChildren(...labels);
        const last = times[times.length - 1];
        const zone = last === undefined ? 'UTC' : clock.zone(Date.parse(last));
        this.zone.textContent = zone;
        const name = clock.isLocal ? words.isLocal(zone) : words.isUtc;
        this.zone.setAttribute('aria-label', name);
        this.zone.title = name;
    }
    private placed(made: HTMLElement, index: number, count: number): HTMLElement {
        made.style.setProperty('--at', String(shareOf(index, count)));
        return made;
    }

    private putVolumes(times: string[], width: number): void {
        const runs = runsOf(times.length, mostBoxes);
        const boxPx = width / Math.max(1, runs.length) / textScale();
        this.boxes = runs.map((run) => {
            const isBetween = run.from === run.to && this.app.timeline.isBetween(times[run.from]!);
            const volume = isBetween ? null : this.volumeOf(times[run.from]!);
            const pattern = run.from === run.to && volume?.vcp ? volume.vcp : null;
            const text = pattern === null || boxPx < patternPx ? '' : String(pattern);
            const box = make('span', {}, text && boxPx >= wordedPx ? words.pattern(text) : text);
            box.classList.toggle('between', isBetween);
            box.classList.toggle('growing', run.from === run.to && volume?.complete === false);
            box.style.setProperty('--at', String(shareOf(run.from - 0.5, times.length)));
            box.style.setProperty('--to', times.length < 2 ? '1' : String(shareOf(run.to + 0.5, times.length)));
            box.title = this.volumeTold(times, run, isBetween, volume);
            box.addEventListener('click', () => this.app.playback.goTo(run.from));
            return { run, box };
        });
        this.volumes.replaceChildren(...this.boxes.map(({ box }) => box));
    }
    private volumeOf(time: string): VolumeAt | null {
        const away = (one: VolumeAt) => Math.abs(Date.parse(one.time ?? '') - Date.parse(time));
        return this.known.find((one) => away(one) <= sameVolumeMs) ?? null;
    }
    private volumeTold(times: string[], { from, to }: Run, isBetween: boolean, volume: VolumeAt | null): string {
        const told = (index: number) => this.told(times[index]!);
        if (from !== to) return words.several(to - from + 1, told(from), told(to));
        if (isBetween) return words.between(told(from));
        return words.volume(told(from), volume?.vcp ?? null, volume?.sweeps ?? null, volume?.complete === false);
    }
    private told(time: string): string {
        const timeMs = Date.parse(time);
        return `${this.clock.second(timeMs)} ${this.clock.zone(timeMs)}`;
    }

    // Shows the cuts of the shown volume. During playback in 3D, which asks for no cuts, shows none.
    private async putCuts(): Promise<void> {
        const { shown, player, state } = this.app;
        if (shown && this.cutsOf === shown) return;
        this.cutsOf = shown;
        this.puts = [];
        this.cutsName.textContent = shown ? this.clock.minute(Date.parse(shown.time)) : '';
        if (!shown) return this.cuts.replaceChildren();
        const [site, another] = shown.loaded.grid.sites;
        if (shown.isBetween) return this.say(panelTexts.scan.between);
        if (!site || another) return this.say(panelTexts.scan.several);
        if (player.isPlaying && !state.isFlat) {
            this.cutsOf = null;
            return this.cuts.replaceChildren();
        }
        try {
            const { rows } = await this.drawing.share.store.rowsOf(shown, site.icao);
            if (this.cutsOf === shown) this.putRows(rows);
        } catch {
            if (this.cutsOf === shown) this.say(panelTexts.scan.none);
        }
    }
    private say(text: string): void {
        this.cuts.replaceChildren(make('span', {}, text));
    }

    private putRows(rows: SweepRow[]): void {
        const boxes = rows.map((row, i) => {
            const choice = cutButton(this.app, row, rows, 'box', () => this.app.showFlat(true));
            const box =
                choice?.shows ?? button(`box-${row.sweep}`, panelTexts.tilts.at(row.elevation_deg), () => undefined);
            if (choice) this.puts.push(choice.put);
            else box.setAttribute('aria-disabled', 'true');
            const seconds = (Date.parse(row.end ?? '') - Date.parse(row.start ?? '')) / 1000;
            box.style.flexGrow = String(seconds > 0 ? seconds : 1);
            const told = this.cutTold(row, rows, i);
            box.title = choice ? told : `${told}\n${words.lacks}`;
            box.setAttribute('aria-label', box.title);
            return box;
        });
        this.cuts.replaceChildren(...boxes);
        this.putShownCut();
    }
    private cutTold(row: SweepRow, rows: SweepRow[], index: number): string {
        const angle = panelTexts.tilts.at(row.elevation_deg);
        const from = row.start === undefined ? '' : this.clock.second(Date.parse(row.start));
        const to = row.end === undefined ? '' : this.told(row.end);
        const [waveform] = waveformOf(row, rows);
        return [
            words.cut(angle, index + 1, rows.length),
            [from, to].filter(Boolean).join(' – '),
            waveform,
            measuredOf(row).join(' '),
        ]
            .filter(Boolean)
            .join('\n');
    }

    // Frames the shown cut, and lets Tab reach it, or the first cut if none is shown.
    private putShownCut(): void {
        for (const put of this.puts) put();
        const boxes = [...this.cuts.querySelectorAll('button')];
        const shown = boxes.find((box) => box.getAttribute('aria-pressed') === 'true');
        for (const box of boxes) box.tabIndex = box === (shown ?? boxes[0]) ? 0 : -1;
        if (!shown) return;
        const { offsetLeft, offsetWidth } = shown;
        const { scrollLeft, clientWidth } = this.cuts;
        if (offsetLeft < scrollLeft || offsetLeft + offsetWidth > scrollLeft + clientWidth)
            this.cuts.scrollLeft = offsetLeft - clientWidth / 2;
    }
    private stepFocus(event: KeyboardEvent): void {
        const boxes = [...this.cuts.querySelectorAll('button')];
        const at = boxes.indexOf(event.target as HTMLButtonElement);
        const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (by === undefined || at < 0) return;
        boxes[at + by]?.focus();
        event.preventDefault();
        event.stopPropagation();
    }
}
