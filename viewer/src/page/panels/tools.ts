// Adds the tools of the pointer (distance, area, flight), and links to the raw volumes of the shown grid.

import { LoadedGrid } from '../../atlas/loaded_grid';
import { domains, hasRaw, isAbsent, rawAt, rawBefore, rawPath } from '../../wire/api';
import { App } from '../app';
import { BearingTool } from '../bearing';
import { button, element, make, press } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { FlyTool } from '../flying';
import { Keys } from '../keys';
import { Measure, MeasureTool } from '../measuring';
import { Pointers, Tool } from '../pointers';
import { panelTexts } from '../later_texts';

interface RawFile {
    station: string;
    name: string;
}

// Returns the files that the server offers of volumes that began at these times.
async function filesOf(volumes: { station: string; time: string }[]): Promise<RawFile[]> {
    const found = await Promise.all(volumes.map(({ station, time }) => rawAt(station, time)));
    return volumes.flatMap(({ station }, i) => {
        const name = found[i]?.raw;
        return name ? [{ station, name }] : [];
    });
}

export class ToolsPanel {
    private toldOf: LoadedGrid | null = null; // grid whose raw volumes the page lists

    constructor(
        private app: App,
        private drawing: Drawing,
        private pointers: Pointers,
        private facts: FactsOfShown,
    ) {}

    begin(keys: Keys): void {
        this.app.on('shown', () => {
            if (!this.toldOf || this.toldOf === this.app.shown?.loaded) return;
            this.toldOf = null;
            this.tell('');
        });
        const tools = element('tools');
        tools.setAttribute('aria-label', panelTexts.tools.name);
        for (const [id, text, key, toggle] of [
            ['tool-distance', panelTexts.tools.distanceName, 'd', () => this.measure('distance')],
            ['tool-area', panelTexts.tools.areaName, 'r', () => this.measure('area')],
            ['tool-bearing', panelTexts.tools.bearingName, 'q', () => this.bear()],
            ['tool-fly', panelTexts.tools.flyName, 'f', () => this.fly()],
        ] as const) {
            tools.append(button(id, text, toggle));
            press(id, false);
            keys.add(key, toggle);
        }
        tools.append(button('raw', panelTexts.tools.raw, () => void this.download()));
        this.drawing.addOverlay((pen, geometry) => {
            const { current } = this.pointers;
            if (current instanceof MeasureTool || current instanceof BearingTool) current.draw(pen, geometry);
        });
        this.app.on('view', () => {
            if (this.app.state.isFlat && this.pointers.current instanceof FlyTool) this.pointers.use(null);
        });
        // News of other domains do not end a tool.
        let { domain } = this.app.state;
        this.app.on('choices', () => {
            const { current } = this.pointers;
            if (domain === this.app.state.domain) return;
            domain = this.app.state.domain;
            if (current instanceof MeasureTool || current instanceof BearingTool) this.pointers.use(null);
        });
    }

    private tell(text: string): void {
        element('tool-says').textContent = text;
    }

    private measure(measure: Measure): void {
        const { current } = this.pointers;
        const isUsed = current instanceof MeasureTool && current.measure === measure;
        this.use(
            `tool-${measure}`,
            isUsed,
            (ended) => new MeasureTool(this.app, this.drawing, measure, (text) => this.tell(text), ended),
        );
    }

    private bear(): void {
        const isUsed = this.pointers.current instanceof BearingTool;
        this.use(
            'tool-bearing',
            isUsed,
            (ended) => new BearingTool(this.app, this.drawing, (text) => this.tell(text), ended),
        );
    }

    private fly(): void {
        const isUsed = this.pointers.current instanceof FlyTool;
        this.app.showFlat(false);
        this.use('tool-fly', isUsed, (ended) => new FlyTool(this.app, this.drawing, ended));
        if (!isUsed) this.tell(panelTexts.tools.flyHint);
    }

    // Ends the tool in use. Then begins the tool that `make` makes, unless that tool was in use (`isUsed`).
    private use(id: string, isUsed: boolean, make: (ended: () => void) => Tool): void {
        this.toldOf = null;
        this.pointers.use(null);
        if (isUsed) return;
        const ended = () => {
            press(id, false);
            this.tell('');
        };
        this.pointers.use(make(ended));
        press(id, true);
    }

    // Returns the raw files of the shown grid, as far as the server offers them. For a region, these are the files of
    // the volumes in the grid. For a frame between volumes, this is the file of the volume before the frame. If the
    // facts of the grid do not come, shows the error and returns null.
    private async rawFiles(): Promise<RawFile[] | null> {
        const { shown } = this.app;
        if (!shown) return [];
        await this.facts.askSites();
        const { sites } = this.facts;
        if (sites)
            return filesOf(
                sites.sites.flatMap(({ site, volumes }) => volumes.map(({ time }) => ({ station: site, time }))),
            );
        if (shown.isBetween) {
            const name = (await rawBefore(shown.domain, shown.time))?.raw;
            return name ? [{ station: shown.domain, name }] : [];
        }
        const facts = await this.facts.ask().catch((error: unknown) => this.app.fail(error));
        if (!facts) return null;
        const { source_files, stations } = facts.provenance;
        const [own] = stations.length === 1 ? await filesOf([{ station: stations[0]!, time: shown.time }]) : [];
        if (source_files.length === 1 && own) return [own];
        const named = source_files.map((name) => ({ station: name.slice(0, 4), name }));
        const isThere = await Promise.all(named.map(({ station, name }) => hasRaw(station, name)));
        if (!isThere.includes(true)) await domains(); // throws if only a proxy answered, not the server
        return named.filter((_, i) => isThere[i]);
    }

    // Lists a link to each raw volume from which the grid was made. If there is a single volume, downloads it at once.
    private async download(): Promise<void> {
        const loaded = this.app.shown?.loaded ?? null;
        const files = await this.rawFiles().catch((error: unknown) => {
            if (isAbsent(error)) return [];
            this.app.fail(error);
            return null;
        });
        if (!files || loaded !== this.app.shown?.loaded) return this.tell('');
        this.toldOf = loaded;
        const links = files.map(({ station, name }) =>
            make('a', { href: rawPath(station, name), download: name }, name),
        );
        if (links.length === 0) return this.tell(panelTexts.tools.noRaw);
        element('tool-says').replaceChildren(...links.flatMap((link) => [link, ' ']));
        if (links.length === 1) links[0]!.click();
    }
}
