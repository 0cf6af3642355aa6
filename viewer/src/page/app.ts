// What the page knows and does: the view, the grids that are loaded, and which one is shown. Panels and
// pointers change it through its methods, and hear what happened.

import { Camera } from '../camera/geometry';
import { LoadedGrid } from '../renderer/renderer';
import { ViewState, addressOf, stateOf } from '../scene/view_state';
import { ColorTable } from '../tables/color_table';
import { Units, namesOf } from '../tables/units';
import { PlayerState, advanced, at, followed, stepped, stopped, withTimes } from '../time/player';
import { ApiError, Domain, domains, tables, times } from '../wire/api';
import { element } from './dom';
import { Loader } from './loader';
import { rememberUnits, rememberedUnits } from './remembered';
import { TableBook } from './table_book';
import { texts } from './texts';

const msAFrame = 250; // of playback

// 'choices': the domain or its moments; 'shown': another grid; 'view': how it is shown; 'camera': from
// where; 'units': in which it writes; 'time': the times, or which of them is wanted; 'restored': the graphics processor forgot all.
export type Happening = 'choices' | 'shown' | 'view' | 'camera' | 'units' | 'time' | 'restored';

export interface Shown {
    key: string;
    loaded: LoadedGrid;
    domain: string;
    moment: string;
    time: string;
}

// What an address does not say of units is as the user had it last.
function stateOfAddress(): ViewState {
    const state = stateOf(location.hash);
    return namesOf(state.units) ? state : { ...state, units: rememberedUnits() };
}

export class App {
    state: ViewState = stateOfAddress();
    domains: Domain[] = [];
    book: TableBook | null = null; // once the server has told its tables
    player: PlayerState = { ...stopped, follows: this.state.time === 'latest' };
    shown: Shown | null = null;
    private heard = new Map<Happening, (() => void)[]>();

    constructor(readonly loader: Loader) {}

    on(happening: Happening, action: () => void): void {
        this.heard.set(happening, [...(this.heard.get(happening) ?? []), action]);
    }
    private tell(happening: Happening): void {
        for (const action of this.heard.get(happening) ?? []) action();
    }

    // Screen readers read news aloud, and not what is said of each picture.
    say(text: string, isNews = true): void {
        element('state').setAttribute('aria-live', isNews ? 'polite' : 'off');
        element('state').textContent = text;
        document.documentElement.dataset['state'] = text;
    }
    fail(error: unknown): void {
        const isGone = error instanceof ApiError && (error.status === 404 || error.status === 410);
        this.say(isGone ? texts.notFound : texts.failed(error instanceof Error ? error.message : String(error)));
    }

    // -- the view

    get table(): ColorTable | undefined {
        return this.book?.of(this.state, this.state.moment);
    }
    get unit(): string {
        return this.domain?.moments.find(one => one.moment === this.state.moment)?.units ?? '';
    }

    // The view was changed by a panel.
    changed(): void {
        this.remember();
        this.tell('view');
    }
    useUnits(units: Units): void {
        this.state.units = units;
        rememberUnits(units);
        this.tell('units');
        this.changed();
    }
    moved(camera: Camera): void {
        this.state.camera = camera;
        this.remember();
        this.tell('camera');
    }
    private remember(): void {
        history.replaceState(null, '', `#${addressOf(this.state)}`);
    }

    // The address was changed by hand, or by going back.
    takeAddress(): void {
        const next = stateOfAddress();
        if (addressOf(next) === addressOf(this.state)) return;
        this.state = next;
        this.tell('units');
        this.player = { ...this.player, follows: next.time === 'latest', isPlaying: false };
        void this.choose(next.domain, next.moment);
    }

    // -- what is shown

    async begin(): Promise<void> {
        const [, known] = await Promise.all([this.findDomains(), tables()]);
        this.book = new TableBook(known);
        if (this.domains.length === 0) return this.say(texts.noGrids);
        await this.choose(this.state.domain, this.state.moment);
    }

    async findDomains(): Promise<void> {
        this.domains = (await domains()).filter(domain => domain.part_of === null && domain.moments.length > 0);
    }

    get domain(): Domain | undefined {
        return this.domains.find(one => one.domain === this.state.domain) ?? this.domains[0];
    }

    async chooseDomain(domain: string): Promise<void> {
        this.player = { ...stopped };
        this.state.camera = { ...this.state.camera, lookAtM: null, zoom: 1 };
        this.state.layers = { ...this.state.layers, section: null, crop: null };
        await this.choose(domain, this.state.moment);
    }

    // Shows a domain and a moment of it, the first of each if there is none of the name.
    async choose(domain: string, moment: string): Promise<void> {
        this.state.domain = this.domains.some(one => one.domain === domain) ? domain : (this.domains[0]?.domain ?? '');
        const moments = (this.domain?.moments ?? []).map(one => one.moment);
        this.state.moment = moments.includes(moment) ? moment : (moments[0] ?? '');
        this.tell('choices');
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
        this.tell('time');
        if (time === undefined) return this.say(texts.notFound);
        const { domain, moment } = this.state;
        try {
            const loaded = await this.loader.load(domain, moment, time);
            if (this.player.times[this.player.at] !== time || this.state.moment !== moment || this.state.domain !== domain) return;
            this.take({ key: Loader.key(domain, moment, time), loaded, domain, moment, time });
        } catch (error) {
            this.fail(error);
        }
    }

    private take(shown: Shown): void {
        this.shown = shown;
        this.state.time = this.player.follows ? 'latest' : shown.time;
        this.loadAhead();
        this.tell('shown');
        this.changed();
    }

    restore(): void {
        this.tell('restored');
        if (this.shown) this.take(this.shown);
    }

    // -- time

    // The neighbors in time, so that a step shows at once.
    private loadAhead(): void {
        const { times: all, at: now } = this.player;
        const next = this.player.isPlaying ? [1, 2, 3] : [1, -1];
        for (const by of next) {
            const time = all[(now + by + all.length) % all.length];
            if (time !== undefined && all.length > 1) this.loader.load(this.state.domain, this.state.moment, time).catch(() => undefined);
        }
    }

    goTo(index: number): void {
        this.player = at(this.player, index);
        void this.showTime();
    }
    step(by: number): void {
        this.player = stepped(this.player, by);
        void this.showTime();
    }
    follow(): void {
        this.player = followed(this.player);
        void this.showTime();
    }
    play(): void {
        this.player = { ...this.player, isPlaying: !this.player.isPlaying, follows: false };
        this.tell('time');
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

    // The server has other times now; `changedTime` is that of a grid that was made again.
    async takeNews(domain: string | undefined, moment: string | undefined, changedTime: string | undefined): Promise<void> {
        if (this.domains.length === 0) {
            await this.findDomains();
            if (this.domains.length > 0) await this.choose(this.state.domain, this.state.moment);
            return;
        }
        if (domain !== this.state.domain || moment !== this.state.moment) return;
        if (changedTime) this.loader.forget(Loader.key(domain, moment, changedTime));
        const before = this.player.times[this.player.at];
        this.player = withTimes(this.player, await times(domain, moment));
        const now = this.player.times[this.player.at];
        if (now !== before || now === changedTime) await this.showTime();
        else this.tell('time');
    }
}
