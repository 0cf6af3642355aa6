// The page: reads what the user does, keeps the state, and draws.

import { Camera, ViewGeometry } from '../camera/geometry';
import { NamedView, namedView, orbited, panned, zoomed } from '../camera/controls';
import { LoadedGrid, Renderer } from '../renderer/renderer';
import { Mark, cityMarks, mapLines, ringLines } from '../scene/ground_lines';
import { planeOf } from '../scene/projection';
import { ViewState, addressOf, commandOf, stateOf } from '../scene/view_state';
import { ColorTable } from '../tables/color_table';
import { PlayerState, advanced, at, followed, stepped, stopped, withTimes } from '../time/player';
import { ApiError, Domain, MapAnswer, Tables, address, domains, gridPath, map, tables, times } from '../wire/api';
import { drawColorBar } from './color_bar';
import { drawLabels } from './labels';
import { Loader } from './loader';
import { boxOf, columnAt, readColumn } from './reading';
import { texts } from './texts';

const stillSlices = 256;
const movingSlices = 128;
const stillAfterMs = 180;
const msAFrame = 250; // of playback

function element<T extends HTMLElement>(id: string): T {
    return document.getElementById(id) as T;
}

class Page {
    private state: ViewState = stateOf(location.hash);
    private picture = element<HTMLCanvasElement>('picture');
    private labels = element<HTMLCanvasElement>('labels');
    private renderer = new Renderer(this.picture);
    private loader = new Loader(this.renderer.mostTexels);
    private domains: Domain[] = [];
    private tables: Tables = { tables: [], usual: {} };
    private player: PlayerState = { ...stopped, follows: this.state.time === 'latest' };
    private shown: { key: string; loaded: LoadedGrid; time: string } | null = null;
    private mapOf = '';
    private marks: Mark[] = [];
    private map: MapAnswer | null = null;
    private movedAt = 0;
    private isDrawing = false;
    private isFinal = false;
    private events: EventSource | null = null;
    private readAt: [number, number] | null = null; // a place that was clicked, meters from the middle

    async begin(): Promise<void> {
        this.putTexts();
        this.listen();
        [this.domains, this.tables] = await Promise.all([domains(), tables()]);
        this.domains = this.domains.filter(domain => domain.part_of === null && domain.moments.length > 0);
        this.hear();
        if (this.domains.length === 0) return this.say(texts.noGrids);
        await this.choose(this.state.domain, this.state.moment);
    }

    private say(text: string): void {
        element('state').textContent = text;
        document.documentElement.dataset['state'] = text;
    }

    private fail(error: unknown): void {
        const isGone = error instanceof ApiError && (error.status === 404 || error.status === 410);
        this.say(isGone ? texts.notFound : texts.failed(error instanceof Error ? error.message : String(error)));
    }

    // -- what is shown

    private get domain(): Domain {
        return this.domains.find(one => one.domain === this.state.domain) ?? this.domains[0]!;
    }

    private async choose(domain: string, moment: string): Promise<void> {
        this.state.domain = this.domains.some(one => one.domain === domain) ? domain : this.domains[0]!.domain;
        const moments = this.domain.moments.map(one => one.moment);
        this.state.moment = moments.includes(moment) ? moment : moments[0]!;
        this.putChoices();
        this.say(texts.loading);
        try {
            this.player = withTimes({ ...this.player, times: [], at: -1 }, await times(this.state.domain, this.state.moment));
            if (!this.player.follows) {
                const wanted = Date.parse(this.state.time);
                const index = this.player.times.findIndex(time => Date.parse(time) >= wanted);
                this.player = { ...this.player, at: index < 0 ? this.player.times.length - 1 : index };
            }
            await this.showTime();
        } catch (error) {
            this.fail(error);
        }
    }

    private async showTime(): Promise<void> {
        const time = this.player.times[this.player.at];
        this.putTimes();
        if (time === undefined) return this.say(texts.notFound);
        const { domain, moment } = this.state;
        try {
            const loaded = await this.loader.load(domain, moment, time);
            if (this.player.times[this.player.at] !== time || this.state.moment !== moment || this.state.domain !== domain) return;
            this.take(loaded, domain, moment, time);
        } catch (error) {
            this.fail(error);
        }
    }

    private take(loaded: LoadedGrid, domain: string, moment: string, time: string): void {
        this.shown = { key: Loader.key(domain, moment, time), loaded, time };
        this.state.time = this.player.follows ? 'latest' : time;
        this.renderer.show(loaded);
        void this.showMap(domain, loaded);
        this.putTitle();
        this.putTables();
        if (this.readAt) this.putReading();
        this.loadAhead();
        this.changed();
    }

    // The neighbors in time, so that a step shows at once.
    private loadAhead(): void {
        const { times: all, at: now } = this.player;
        const next = this.player.isPlaying ? [1, 2, 3] : [1, -1];
        for (const by of next) {
            const time = all[(now + by + all.length) % all.length];
            if (time !== undefined && all.length > 1) this.loader.load(this.state.domain, this.state.moment, time).catch(() => undefined);
        }
    }

    private async showMap(domain: string, loaded: LoadedGrid): Promise<void> {
        const { grid } = loaded;
        const key = `${domain} ${grid.nx} ${grid.ny} ${grid.spacing} ${grid.centerDeg.join()} ${grid.offsetCells.join()}`;
        if (this.mapOf === key) return;
        this.mapOf = key;
        const plane = planeOf(grid);
        const { halfXM, halfYM } = boxOf(grid);
        const corners = [-1, 0, 1].flatMap(x => [-1, 0, 1].map(y => plane.toPlace([x * 1.6 * halfXM, y * 1.6 * halfYM])));
        const degrees = (name: 'latitudeDeg' | 'longitudeDeg') => corners.map(corner => corner[name]);
        try {
            this.map = await map(
                Math.max(-180, Math.min(...degrees('longitudeDeg'))),
                Math.max(-89, Math.min(...degrees('latitudeDeg'))),
                Math.min(180, Math.max(...degrees('longitudeDeg'))),
                Math.min(89, Math.max(...degrees('latitudeDeg'))),
                halfXM > 6e5 ? 1 : 0,
            );
        } catch {
            this.map = { credit: '', lines: [], cities: [] }; // the grid alone is shown
        }
        if (this.mapOf !== key) return;
        const rings = ringLines(grid.sites, plane, halfXM, halfYM);
        this.renderer.showLines([...mapLines(this.map, plane, Math.max(halfXM, halfYM)), ...rings.lines]);
        this.marks = [...rings.marks, ...cityMarks(this.map.cities, plane, halfXM, halfYM)];
        this.draw();
    }

    private get table(): ColorTable | undefined {
        const own = this.tables.tables.find(table => table.name === this.state.colors && table.moment === this.state.moment);
        return own ?? this.tables.tables.find(table => table.name === this.tables.usual[this.state.moment]);
    }

    // -- drawing

    private geometry(): ViewGeometry | null {
        if (!this.shown) return null;
        const ratio = window.devicePixelRatio || 1;
        const width = Math.max(16, Math.round(this.picture.clientWidth * ratio));
        const height = Math.max(16, Math.round(this.picture.clientHeight * ratio));
        return new ViewGeometry(boxOf(this.shown.loaded.grid), this.state.camera, this.state.exaggeration, width, height);
    }

    private changed(): void {
        history.replaceState(null, '', `#${addressOf(this.state)}`);
        this.draw();
    }

    private moved(camera: Camera): void {
        this.state.camera = camera;
        this.movedAt = performance.now();
        this.changed();
    }

    private draw(): void {
        this.isFinal = false;
        if (this.isDrawing) return;
        this.isDrawing = true;
        requestAnimationFrame(() => this.drawNow());
    }

    private drawNow(): void {
        this.isDrawing = false;
        const geometry = this.geometry();
        const table = this.table;
        if (!geometry || !table || !this.shown) return;
        const isMoving = performance.now() - this.movedAt < stillAfterMs;
        const slices = isMoving ? movingSlices : stillSlices;
        const begun = performance.now();
        this.renderer.draw({
            geometry,
            slices,
            opacity: this.state.opacity,
            table,
            leastValue: this.state.least ?? -1e9,
            hasVolume: true,
            hasGround: this.state.hasGround,
        });
        this.renderer.finish();
        const ms = Math.round(performance.now() - begun);
        this.drawNames(geometry);
        drawColorBar(element<HTMLCanvasElement>('bar'), table, table.unit, this.state.least);
        document.documentElement.dataset['frameMs'] = String(ms);
        if (isMoving) {
            window.setTimeout(() => this.draw(), stillAfterMs);
        } else if (!this.isFinal) {
            this.isFinal = true;
            this.say(texts.steps(slices, ms));
            document.documentElement.dataset['drawn'] = this.shown.key;
        }
    }

    private drawNames(geometry: ViewGeometry): void {
        if (this.labels.width !== geometry.width || this.labels.height !== geometry.height) {
            this.labels.width = geometry.width;
            this.labels.height = geometry.height;
        }
        const taken = ['head', 'foot', 'settings', 'bar', 'reading']
            .map(id => element(id).getBoundingClientRect())
            .filter(rect => rect.width > 0)
            .map(rect => ({ left: rect.left, top: rect.top, right: rect.right, bottom: rect.bottom }));
        drawLabels(this.labels.getContext('2d')!, geometry, this.marks, taken, window.devicePixelRatio || 1);
    }

    // -- texts and choices

    private button(id: string, text: string, action: () => void): HTMLButtonElement {
        const button = document.createElement('button');
        button.id = id;
        button.textContent = text;
        button.addEventListener('click', action);
        return button;
    }

    private putTexts(): void {
        element('colors-name').textContent = texts.colors;
        element('least-name').textContent = texts.threshold;
        element('opacity-name').textContent = texts.opacity;
        element('exaggeration-name').textContent = texts.exaggeration;
        for (const [id, text] of [
            ['open', texts.settings],
            ['play', texts.play],
            ['follow', texts.latest],
        ] as const)
            element(id).textContent = text;
        for (const [id, sign, text] of [
            ['earlier', '‹', texts.earlier],
            ['later', '›', texts.later],
        ] as const) {
            element(id).textContent = sign;
            element(id).setAttribute('aria-label', text);
        }
        element('times').setAttribute('aria-label', texts.time);
        for (const view of ['top', 'south', 'oblique'] as const) {
            element('views').append(this.button(`view-${view}`, texts[view], () => this.look(view)));
        }
        element('views').append(this.button('perspective', texts.perspective, () => this.togglePerspective()));
        element('actions').append(
            this.button('share', texts.share, () => this.copy(location.href, texts.shared)),
            this.button('save', texts.save, () => this.save()),
            this.button('command', texts.command, () => this.copy(commandOf(this.state, this.picture.width, this.picture.height), texts.commandCopied)),
            this.button('netcdf', texts.netcdf, () => this.download()),
            this.button('help', texts.help, () => this.showHelp()),
        );
    }

    private putChoices(): void {
        const select = element<HTMLSelectElement>('domain');
        select.replaceChildren(
            ...this.domains.map(domain => {
                const option = document.createElement('option');
                option.value = option.textContent = domain.domain;
                option.selected = domain.domain === this.state.domain;
                return option;
            }),
        );
        element('moments').replaceChildren(
            ...this.domain.moments.map(({ moment }) => {
                const button = this.button(`moment-${moment}`, moment, () => void this.choose(this.state.domain, moment));
                button.setAttribute('aria-pressed', String(moment === this.state.moment));
                return button;
            }),
        );
    }

    private putTables(): void {
        const select = element<HTMLSelectElement>('colors');
        const own = this.tables.tables.filter(table => table.moment === this.state.moment);
        const shown = this.table;
        select.replaceChildren(
            ...own.map(table => {
                const option = document.createElement('option');
                option.value = option.textContent = table.name;
                option.selected = table === shown;
                return option;
            }),
        );
        const least = element<HTMLInputElement>('least');
        if (shown) {
            least.min = String(shown.bar_begin);
            least.max = String(shown.end);
            least.step = String((shown.end - shown.bar_begin) / 100);
            least.value = String(this.state.least ?? shown.bar_begin);
        }
        element('least-value').textContent = this.state.least === null ? '' : `${Number(this.state.least.toFixed(1))} ${shown?.unit ?? ''}`;
        element<HTMLInputElement>('opacity').value = String(Math.log2(this.state.opacity));
        element<HTMLInputElement>('exaggeration').value = String(this.state.exaggeration);
        element('perspective').setAttribute('aria-pressed', String(this.state.camera.fieldOfViewDeg > 0));
    }

    private putTitle(): void {
        const { grid } = this.shown!.loaded;
        const names = grid.sites.map(site => site.icao).join(', ');
        const time = new Date(grid.timeMs).toISOString().replace('T', ' ').replace(/\.\d+Z/, ' UTC');
        element('title').textContent = `${names}  ${time}${grid.isPartial ? `  ${texts.partial}` : ''}`;
        document.title = `${this.state.domain} ${this.state.moment} ${time} · ${texts.title}`;
    }

    private putTimes(): void {
        const slider = element<HTMLInputElement>('times');
        slider.max = String(Math.max(0, this.player.times.length - 1));
        slider.value = String(Math.max(0, this.player.at));
        slider.setAttribute('aria-valuetext', this.player.times[this.player.at] ?? '');
        element('play').textContent = this.player.isPlaying ? texts.pause : texts.play;
        element('follow').setAttribute('aria-pressed', String(this.player.follows));
    }

    // -- what the user does

    private look(view: NamedView): void {
        this.moved(namedView(this.state.camera, view));
    }

    private togglePerspective(): void {
        this.moved({ ...this.state.camera, fieldOfViewDeg: this.state.camera.fieldOfViewDeg > 0 ? 0 : 40 });
        this.putTables();
    }

    private play(): void {
        this.player = { ...this.player, isPlaying: !this.player.isPlaying, follows: false };
        this.putTimes();
        if (this.player.isPlaying) {
            this.loadAhead();
            this.tick();
        }
    }

    private tick(): void {
        if (!this.player.isPlaying) return;
        const { domain, moment } = this.state;
        const { player, waitsFor } = advanced(this.player, time => this.loader.has(Loader.key(domain, moment, time)));
        if (waitsFor !== null) {
            this.say(texts.waiting(waitsFor));
            this.loader.load(domain, moment, waitsFor).catch(error => this.fail(error));
        } else if (player !== this.player) {
            this.player = player;
            void this.showTime();
        }
        window.setTimeout(() => this.tick(), msAFrame);
    }

    private copy(text: string, said: string): void {
        navigator.clipboard.writeText(text).then(
            () => this.say(said),
            () => window.prompt(said, text),
        );
    }

    private save(): void {
        const all = document.createElement('canvas');
        all.width = this.picture.width;
        all.height = this.picture.height;
        const pen = all.getContext('2d')!;
        pen.drawImage(this.picture, 0, 0);
        pen.drawImage(this.labels, 0, 0);
        const link = document.createElement('a');
        link.download = `${this.state.domain}_${this.state.moment}_${(this.shown?.time ?? '').replace(/[:]/g, '')}.png`;
        link.href = all.toDataURL('image/png');
        link.click();
    }

    private download(): void {
        if (this.shown) location.href = address(`${gridPath(this.state.domain, this.state.moment, this.shown.time)}/netcdf`);
    }

    private showHelp(): void {
        const box = element('reading');
        this.readAt = null;
        box.replaceChildren(
            ...texts.helpText.map(text => {
                const line = document.createElement('p');
                line.textContent = text;
                return line;
            }),
        );
        box.hidden = false;
    }

    private read(x: number, y: number): void {
        this.readAt = this.geometry()?.ground(x, y) ?? null;
        this.putReading();
    }

    // Also after another volume or moment came: the same place is read again.
    private putReading(): void {
        const box = element('reading');
        box.hidden = !this.readAt || !this.shown;
        if (!this.readAt || !this.shown) return;
        const { grid } = this.shown.loaded;
        const column = columnAt(grid, this.readAt[0], this.readAt[1]);
        const place = planeOf(grid).toPlace(this.readAt);
        const title = document.createElement('h2');
        title.textContent = `${place.latitudeDeg.toFixed(3)}, ${place.longitudeDeg.toFixed(3)}`;
        const body = document.createElement('div');
        if (column) this.putColumn(body, column);
        box.replaceChildren(title, body);
        this.draw();
    }

    private putColumn(body: HTMLElement, [x, y]: [number, number]): void {
        const { grid } = this.shown!.loaded;
        const unit = this.domain.moments.find(one => one.moment === this.state.moment)?.units ?? '';
        const reading = readColumn(grid, x, y);
        const km = (meters: number) => (meters / 1000).toFixed(1);
        const line = document.createElement('p');
        line.textContent = reading.greatest
            ? `${texts.highest} ${reading.greatest.value} ${unit} at ${km(reading.greatest.heightM)} ${texts.heightAbove}`
            : reading.seenFromM === null
              ? texts.notSeen
              : texts.noEcho;
        body.append(line);
        if (reading.seenFromM !== null) {
            const seen = document.createElement('p');
            seen.textContent = `${texts.seenTo} ${km(reading.seenFromM)} – ${km(reading.seenToM!)} ${texts.heightAbove}`;
            body.append(seen);
        }
        const table = document.createElement('table');
        const told = reading.levels.filter(level => level.value !== null || level.code === 2);
        const every = Math.ceil(told.length / 10);
        for (const level of told.filter((_, i) => i % every === 0).reverse()) {
            const row = table.insertRow();
            row.insertCell().textContent = `${km(level.heightM)} km`;
            row.insertCell().textContent = level.value === null ? texts.rangeFolded : `${level.value} ${unit}`;
        }
        body.append(table);
    }

    private listen(): void {
        element<HTMLSelectElement>('domain').addEventListener('change', event => {
            this.player = { ...stopped };
            this.readAt = null;
            element('reading').hidden = true;
            this.state.camera = { ...this.state.camera, lookAtM: null, zoom: 1 };
            void this.choose((event.target as HTMLSelectElement).value, this.state.moment);
        });
        element<HTMLSelectElement>('colors').addEventListener('change', event => {
            this.state.colors = (event.target as HTMLSelectElement).value;
            this.putTables();
            this.changed();
        });
        const slider = (id: string, take: (value: number) => void) =>
            element<HTMLInputElement>(id).addEventListener('input', event => {
                take(Number((event.target as HTMLInputElement).value));
                this.movedAt = performance.now();
                this.changed();
            });
        slider('least', value => {
            const lowest = Number(element<HTMLInputElement>('least').min);
            this.state.least = value <= lowest ? null : value;
            this.putTables();
        });
        slider('opacity', value => (this.state.opacity = Number((2 ** value).toFixed(3))));
        slider('exaggeration', value => (this.state.exaggeration = value));
        element('times').addEventListener('input', event => {
            this.player = at(this.player, Number((event.target as HTMLInputElement).value));
            void this.showTime();
        });
        element('open').addEventListener('click', () => this.openSettings(element('settings').hidden));
        element('play').addEventListener('click', () => this.play());
        element('earlier').addEventListener('click', () => this.step(-1));
        element('later').addEventListener('click', () => this.step(1));
        element('follow').addEventListener('click', () => this.follow());
        this.listenToPointers();
        this.picture.addEventListener('keydown', event => this.key(event));
        window.addEventListener('resize', () => this.draw());
        window.addEventListener('hashchange', () => {
            const next = stateOf(location.hash);
            if (addressOf(next) === addressOf(this.state)) return;
            this.state = next;
            this.player = { ...this.player, follows: next.time === 'latest', isPlaying: false };
            void this.choose(next.domain, next.moment);
        });
        this.picture.addEventListener('webglcontextrestored', () => {
            this.renderer.forget();
            this.mapOf = '';
            if (this.shown) this.take(this.shown.loaded, this.state.domain, this.state.moment, this.shown.time);
        });
    }

    private openSettings(isOpen: boolean): void {
        element('settings').hidden = !isOpen;
        element('open').setAttribute('aria-expanded', String(isOpen));
        this.draw();
    }

    private step(by: number): void {
        this.player = stepped(this.player, by);
        void this.showTime();
    }

    private follow(): void {
        this.player = followed(this.player);
        void this.showTime();
    }

    private listenToPointers(): void {
        const pointers = new Map<number, PointerEvent>();
        let travelled = 0;
        const ratio = () => window.devicePixelRatio || 1;
        this.picture.addEventListener('pointerdown', event => {
            this.picture.setPointerCapture(event.pointerId);
            pointers.set(event.pointerId, event);
            travelled = 0;
        });
        this.picture.addEventListener('pointermove', event => {
            const before = pointers.get(event.pointerId);
            const geometry = this.geometry();
            if (!before || !geometry) return;
            const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
            travelled += Math.abs(dx) + Math.abs(dy);
            pointers.set(event.pointerId, event);
            if (pointers.size === 2) {
                const [one, other] = [...pointers.values()] as [PointerEvent, PointerEvent];
                const fixed = one.pointerId === event.pointerId ? other : one;
                const was = Math.hypot(before.clientX - fixed.clientX, before.clientY - fixed.clientY);
                const is = Math.hypot(event.clientX - fixed.clientX, event.clientY - fixed.clientY);
                let camera = zoomed(this.state.camera, geometry, is / Math.max(1, was));
                camera = panned(camera, geometry, (dx / 2) * ratio(), (dy / 2) * ratio());
                this.moved(camera);
            } else if (event.shiftKey || (event.buttons & 2) !== 0) {
                this.moved(panned(this.state.camera, geometry, dx * ratio(), dy * ratio()));
            } else {
                this.moved(orbited(this.state.camera, dx, dy));
            }
        });
        const up = (event: PointerEvent) => {
            pointers.delete(event.pointerId);
            if (event.type === 'pointerup' && travelled < 4) this.read(event.offsetX * ratio(), event.offsetY * ratio());
        };
        this.picture.addEventListener('pointerup', up);
        this.picture.addEventListener('pointercancel', up);
        this.picture.addEventListener('contextmenu', event => event.preventDefault());
        this.picture.addEventListener(
            'wheel',
            event => {
                event.preventDefault();
                const geometry = this.geometry();
                if (geometry) this.moved(zoomed(this.state.camera, geometry, Math.exp(-event.deltaY * 0.0015), event.offsetX * ratio(), event.offsetY * ratio()));
            },
            { passive: false },
        );
    }

    private key(event: KeyboardEvent): void {
        const geometry = this.geometry();
        if (!geometry || event.ctrlKey || event.metaKey || event.altKey) return;
        const { camera } = this.state;
        const ways: Record<string, [number, number]> = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
        const way = ways[event.key];
        if (way) {
            this.moved(event.shiftKey ? panned(camera, geometry, 2 * way[0], 2 * way[1]) : orbited(camera, way[0], way[1]));
        } else {
            const actions: Record<string, () => void> = {
                '+': () => this.moved(zoomed(camera, geometry, 1.25)),
                '=': () => this.moved(zoomed(camera, geometry, 1.25)),
                '-': () => this.moved(zoomed(camera, geometry, 0.8)),
                t: () => this.look('top'),
                s: () => this.look('south'),
                o: () => this.look('oblique'),
                p: () => this.togglePerspective(),
                l: () => this.follow(),
                ' ': () => this.play(),
                ',': () => this.step(-1),
                '.': () => this.step(1),
                '?': () => this.showHelp(),
                Escape: () => {
                    this.readAt = null;
                    element('reading').hidden = true;
                    this.openSettings(false);
                },
            };
            const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
            if (!action) return;
            action();
        }
        event.preventDefault();
    }

    // -- what the server tells

    private hear(): void {
        this.events = new EventSource(address('api/v1/events'));
        const take = (event: MessageEvent<string>) => void this.heard(JSON.parse(event.data) as { domain?: string; moment?: string; grid?: string });
        for (const kind of ['sweep_gridded', 'volume_complete', 'mosaic', 'grid_evicted']) this.events.addEventListener(kind, take as EventListener);
    }

    private async heard(told: { domain?: string; moment?: string; grid?: string }): Promise<void> {
        if (this.domains.length === 0) {
            this.domains = (await domains()).filter(domain => domain.part_of === null && domain.moments.length > 0);
            if (this.domains.length > 0) await this.choose(this.state.domain, this.state.moment);
            return;
        }
        const { domain, moment } = this.state;
        if (told.domain !== domain || told.moment !== moment) return;
        if (told.grid) this.loader.forget(Loader.key(domain, moment, told.grid));
        const before = this.player.times[this.player.at];
        this.player = withTimes(this.player, await times(domain, moment));
        const now = this.player.times[this.player.at];
        if (now !== before || now === told.grid) await this.showTime();
        else this.putTimes();
    }
}

const page = (() => {
    try {
        return new Page();
    } catch (error) {
        const isWithout = error instanceof Error && error.message === 'webgl2';
        element('state').textContent = isWithout ? texts.noWebgl : texts.failed(String(error));
        return null;
    }
})();
page?.begin().catch(error => {
    element('state').textContent = texts.failed(error instanceof Error ? error.message : String(error));
});
