// Holds the state of the page: the view, the domain and moment that are chosen, and which grid is shown. Panels and
// pointers change it through its methods, and hear what happened. Showing loads the wanted time, Playback chooses it,
// and News takes what the server tells.

import { Camera } from '../camera/geometry';
import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewState, addressOf } from '../scene/view_state';
import { ColorTable } from '../wire/color_tables';
import { PlayerState, stopped } from '../time/player';
import { Timeline, toleratedFutureMs } from '../time/timeline';
import { Units } from '../tables/units';
import { ApiError, Domain, domains, isRegion, region, tables } from '../wire/api';
import { AddressBar, stateOfAddress, timeThatIsNone } from './address_bar';
import { element } from './dom';
import { Loader } from './loader';
import { News } from './news';
import { Playback } from './playback';
import { rememberUnits } from './remembered';
import { ServerState } from './server_state';
import { Showing } from './showing';
import { TableBook } from './table_book';
import { texts } from './texts';

// 'choices': the domain or its moments; 'shown': another grid; 'view': how it is shown; 'camera': from where;
// 'units': the units of texts; 'time': the times, or which of them is wanted; 'restored': the graphics
// processor forgot all; 'map': the map of all stations is opened or left; 'cells': more of a grid in parts, or
// of the layers, is there; 'notice': what a user must know of the server, the radars, or what was asked for.
export type Happening =
    'choices' | 'shown' | 'view' | 'camera' | 'units' | 'time' | 'restored' | 'map' | 'cells' | 'notice';

export interface Shown {
    key: string;
    loaded: LoadedGrid;
    domain: string;
    moment: string;
    time: string;
    isBetween: boolean; // made between volumes
}

export class App {
    state: ViewState = stateOfAddress();
    domains: Domain[] = [];
    book: TableBook | null = null; // once the server has told its tables
    shown: Shown | null = null;
    isOnMap = false; // of all stations, where a domain is chosen
    // Fetches what else a picture of `next` needs. Until it has come, the one before stays. Null: it is there.
    alongside: (next: Shown, isAhead: boolean) => Promise<void> | null = () => null;
    isShownWhole: () => boolean = () => true; // the picture has all of what is shown
    isGraphicsLost = false; // nothing can be drawn
    readonly server = new ServerState(() => this.tell('notice'));
    missed = ''; // what was asked for and is not there
    missedTime = ''; // a time of that
    readonly timeline = new Timeline(
        this.state.time === 'latest',
        () => this.state.betweenS,
        () =>
            Math.max(
                this.server.nowMs + toleratedFutureMs,
                Date.parse(this.domain?.moments.find((one) => one.moment === this.state.moment)?.newest ?? '') || 0,
            ),
    );
    readonly showing = new Showing(this);
    readonly playback = new Playback(this);
    readonly news = new News(this);
    choices = 0; // how often a domain and moment were chosen
    askedMoment = ''; // what choose() was asked for, which may not be there
    private askedDomain = '';
    unreadTime = timeThatIsNone(); // of the address
    private heard = new Map<Happening, (() => void)[]>();
    private addressBar = new AddressBar(() => addressOf(this.state));

    constructor(readonly loader: Loader) {}

    get player(): PlayerState {
        return this.timeline.player;
    }
    set player(player: PlayerState) {
        this.timeline.player = player;
    }

    on(happenings: Happening | Happening[], action: () => void): void {
        for (const happening of [happenings].flat())
            this.heard.set(happening, [...(this.heard.get(happening) ?? []), action]);
    }
    tell(happening: Happening): void {
        for (const action of this.heard.get(happening) ?? []) action();
    }

    // Shows a text. Screen readers read it aloud if it is news.
    say(text: string, isNews = true): void {
        element('state').setAttribute('aria-live', isNews ? 'polite' : 'off');
        element('state').textContent = text;
        document.documentElement.dataset['state'] = text;
    }
    fail(error: unknown): void {
        // fetch() throws a TypeError if there was no answer at all.
        if (error instanceof TypeError) {
            this.server.isBehind = true;
            return this.say(texts.notice.noServer);
        }
        const isGone = error instanceof ApiError && (error.status === 404 || error.status === 410);
        this.say(isGone ? texts.notFound : texts.failed(error instanceof Error ? error.message : String(error)));
    }

    // -- the view

    get table(): ColorTable | undefined {
        return this.book?.of(this.state, this.state.moment);
    }
    // Color table of what is drawn: while another moment comes, the old one keeps its colors.
    get shownTable(): ColorTable | undefined {
        return this.shown ? this.book?.of(this.state, this.shown.moment) : undefined;
    }
    get unit(): string {
        const moment = this.shown?.moment ?? this.state.moment;
        return this.domain?.moments.find((one) => one.moment === moment)?.units ?? '';
    }

    // Call after a change of the view.
    changed(): void {
        if (this.player.isPlaying) this.addressBar.writeSoon();
        else this.addressBar.write();
        this.tell('view');
    }
    cellsCame(): void {
        this.tell('cells');
    }
    useUnits(units: Units): void {
        this.state.units = units;
        rememberUnits(units);
        this.tell('units');
        this.changed();
    }
    moved(camera: Camera): void {
        this.state.camera = camera;
        this.addressBar.writeSoon();
        this.tell('camera');
    }
    // Returns a link to what is shown now, even if this page follows the newest.
    get link(): string {
        this.addressBar.write();
        const { shown, state } = this;
        const isShown = shown?.domain === state.domain && shown.moment === state.moment;
        const time = isShown ? shown.time : (this.timeline.now ?? state.time);
        return new URL(`#${addressOf({ ...state, time })}`, location.href).href;
    }

    // Takes an address that was typed, or that going back in the browser brought. Meanwhile the page may have written
    // another one.
    takeAddress(hash: string): void {
        const [next, unreadTime] = [stateOfAddress(hash), timeThatIsNone(hash)];
        if (next.domain === '' && this.domains.length > 1) return this.openMap();
        if (!this.isOnMap && unreadTime === '' && addressOf(next) === addressOf(this.state)) return;
        [this.state, this.unreadTime] = [next, unreadTime];
        this.tell('units');
        this.player = { ...this.player, follows: next.time === 'latest', isPlaying: false };
        void this.choose(next.domain, next.moment);
    }

    // -- what is shown

    async begin(): Promise<void> {
        const [, known] = await Promise.all([this.findDomains(), tables()]);
        this.book = new TableBook(known);
        if (this.domains.length === 0) return this.say(texts.noGrids);
        if (this.state.domain === '' && this.domains.length > 1) return this.openMap();
        await this.choose(this.state.domain, this.state.moment);
    }

    async findDomains(): Promise<void> {
        const found = (await domains()).filter((domain) => domain.part_of === null && domain.moments.length > 0);
        this.domains = [...found, ...this.domains.filter((domain) => isRegion(domain.domain))];
        if (this.missed === '' || this.missedTime !== '' || this.unreadTime !== '') return;
        if (this.isAskedThere) this.miss('');
        // Sites that reach it may have come.
        else if (isRegion(this.askedDomain))
            void this.findRegion(this.askedDomain).then(
                () => this.missedTime === '' && this.isAskedThere && this.miss(''),
                () => undefined,
            );
    }
    private get isAskedThere(): boolean {
        const own = this.domains.find((one) => one.domain.toLowerCase() === this.askedDomain.toLowerCase());
        return (
            own !== undefined &&
            (this.isOnMap || this.askedMoment === '' || own.moments.some((one) => one.moment === this.askedMoment))
        );
    }

    get hasLists(): boolean {
        return this.timeline.stored.length > 0;
    }
    takeGraphics(isThere: boolean): void {
        this.isGraphicsLost = !isThere;
        this.tell('notice');
    }
    miss(text: string, time = ''): void {
        [this.missed, this.missedTime] = [text, time];
        this.tell('notice');
    }
    // Says that a time is not there, beside what else is missed.
    missTime(time: string): void {
        this.miss([this.missed, texts.notice.otherTime(time)].filter(Boolean).join(' '), time);
    }

    // Makes a region a domain, with its sites and times. Errors: the server's answer for its box.
    async findRegion(domain: string): Promise<void> {
        const found = await region(domain);
        this.domains = [...this.domains.filter((one) => one.domain !== domain), found];
    }

    private openMap(): void {
        this.miss('');
        this.addressBar.drop();
        this.player = { ...this.player, isPlaying: false };
        this.isOnMap = true;
        this.tell('map');
    }
    // Opens the map, so that going back in the browser returns to the view.
    goToMap(): void {
        if (!this.isOnMap) this.addressBar.write();
        history.pushState(null, '', '#');
        this.openMap();
    }
    // Opens a domain from the map.
    async enter(domain: string): Promise<void> {
        history.pushState(null, '', '#');
        if (domain === this.shown?.domain && domain === this.state.domain) await this.choose(domain, this.state.moment);
        else await this.chooseDomain(domain);
    }

    get domain(): Domain | undefined {
        return this.domains.find((one) => one.domain === this.state.domain) ?? this.domains[0];
    }

    private leaveMap(): void {
        if (!this.isOnMap) return;
        this.isOnMap = false;
        this.tell('map');
    }

    async chooseDomain(domain: string): Promise<void> {
        this.player = { ...stopped };
        this.state.camera = { ...this.state.camera, lookAtM: null, zoom: 1 };
        this.state.layers = { ...this.state.layers, section: null, crop: null };
        await this.choose(domain, this.state.moment);
    }

    // Shows a domain and a moment of it. If the domain is not there, opens the map of all. If there is only
    // one domain, or no such moment, shows the first one, and the page says so.
    async choose(domain: string, moment: string): Promise<void> {
        this.miss('');
        [this.askedDomain, this.askedMoment] = [domain, moment];
        if (isRegion(domain) && !this.domains.some((one) => one.domain === domain)) {
            const choice = ++this.choices;
            try {
                await this.findRegion(domain);
            } catch (error) {
                if (choice !== this.choices) return;
                // The region is asked for again when the server answers.
                if (error instanceof TypeError) {
                    this.leaveMap();
                    this.state.domain = domain;
                } else {
                    this.backToShown();
                    this.miss(error instanceof Error ? error.message : '');
                }
                return this.fail(error);
            }
            if (choice !== this.choices) return;
        }
        domain = this.domains.find((one) => one.domain.toLowerCase() === domain.toLowerCase())?.domain ?? domain;
        const isThere = domain === '' || this.domains.some((one) => one.domain === domain);
        if (!isThere && this.domains.length > 1) {
            this.backToShown();
            this.openMap();
            return this.miss(texts.notice.noDomain(domain));
        }
        this.leaveMap();
        this.state.domain = domain !== '' && isThere ? domain : (this.domains[0]?.domain ?? '');
        const moments = (this.domain?.moments ?? []).map((one) => one.moment);
        const before = this.state.moment;
        this.state.moment = moments.includes(moment) ? moment : (moments[0] ?? '');
        // The threshold is a number in the unit of its moment.
        if (before !== '' && this.state.moment !== before) this.state.least = null;
        const missed = [
            isThere ? '' : texts.notice.otherDomain(domain, this.state.domain),
            moment === '' || moment === this.state.moment
                ? ''
                : texts.notice.otherMoment(this.state.domain, moment, this.state.moment),
            this.unreadTime === '' ? '' : texts.notice.noTime(this.unreadTime),
        ];
        this.miss(missed.filter(Boolean).join(' '));
        return this.showing.showChosen();
    }
    // Returns to the domain and moment that are shown. The threshold of another moment is in another unit, so it goes.
    private backToShown(): void {
        const { shown, state } = this;
        if (shown)
            this.state = {
                ...state,
                domain: shown.domain,
                moment: shown.moment,
                least: shown.moment === state.moment ? state.least : null,
            };
    }
}
