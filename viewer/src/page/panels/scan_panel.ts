// Shows the cuts of the shown volume scan, and how far the scan is.

import { valueText } from '../../tables/units';
import { SweepRow, VolumeRow, isAbsent, sweeps, volumesUntil } from '../../wire/api';
import { App, Shown } from '../app';
import { element, leaveByEscape, make, paragraph } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { panelTexts } from '../later_texts';
import { cutCells, progressOf, waveformOf } from '../scan';
import { openSettings } from './look';
import { cutButton } from './tilts';

const words = panelTexts.scan;

export class ScanPanel {
    private puts: (() => void)[] = []; // press the button of the shown cut
    private box = make('section', { id: 'scan', hidden: '', 'aria-label': words.title });

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    begin(keys: Keys): void {
        element('settings').after(this.box);
        leaveByEscape(this.box, 'scan-open', () => this.open(false));
        element('scan-open').addEventListener('click', () => this.open(this.box.hidden));
        for (const other of ['open', 'layers-open']) element(other).addEventListener('click', () => this.open(false));
        keys.add('Escape', () => this.open(false));
        this.app.on(['shown', 'units'], () => void this.put());
        this.app.on('view', () => {
            for (const put of this.puts) put();
        });
    }

    private open(isOpen: boolean): void {
        if (isOpen) {
            openSettings(this.drawing, false);
            element('layers').hidden = true;
            element('layers-open').setAttribute('aria-expanded', 'false');
        }
        this.box.hidden = !isOpen;
        element('scan-open').setAttribute('aria-expanded', String(isOpen));
        void this.put();
        this.drawing.draw();
    }

    // Asks for the cuts of the shown volume, and shows them. Keeps the old list until then.
    private async put(): Promise<void> {
        const { shown } = this.app;
        if (this.box.hidden || !shown) return;
        const [site, another] = shown.loaded.grid.sites;
        if (shown.isBetween) return this.say(words.between);
        if (!site || another) return this.say(words.several);
        try {
            const [rows, volumes] = await Promise.all([
                sweeps(site.icao, shown.time),
                volumesUntil(site.icao, shown.time),
            ]);
            this.putRows(shown, rows, volumes);
        } catch (error) {
            if (shown !== this.app.shown) return;
            if (isAbsent(error)) this.say(words.none);
            else this.app.fail(error);
        }
    }
    private say(text: string): void {
        this.box.replaceChildren(make('h2', {}, words.title), paragraph(text));
    }

    private putRows(shown: Shown, rows: SweepRow[], volumes: VolumeRow[]): void {
        if (shown !== this.app.shown) return;
        const { text, share } = progressOf(rows, volumes, this.app.server.nowMs);
        this.say(text);
        if (share !== null && share < 1)
            this.box.append(make('progress', { max: '1', value: String(share), 'aria-label': text }));
        const head = make('tr', {}, ...words.head.map((name) => make('th', { scope: 'col' }, name)));
        const { units } = this.app.state;
        this.puts = [];
        const body = rows.map((row) => {
            const cells = cutCells(row, rows, (mps) => valueText(mps, 'm/s', units, 1));
            const line = make('tr', {}, ...cells.map((cell) => make('td', {}, cell)));
            line.cells[1]!.title = waveformOf(row, rows)[1];
            const choice = cutButton(this.app, row, rows);
            if (choice) {
                line.cells[0]!.replaceChildren(choice.shows);
                this.puts.push(choice.put);
            }
            return line;
        });
        this.box.append(make('table', {}, make('thead', {}, head), make('tbody', {}, ...body)));
    }
}
