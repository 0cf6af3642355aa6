// Holds the state of the page and acts on it: the view, the loaded grids, and which one is shown. Panels and
// pointers change it through its methods, and hear what happened.

import { Camera } from '../camera/geometry';
import { isClearAir } from '../fields/clear_air';
import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewState, addressOf } from '../scene/view_state';
import { ColorTable } from '../wire/color_tables';
import { outdatedBy } from '../time/outdated';
import { PlayerState, advanced, at, looped, stepped, stopped } from '../time/player';
import { Timeline, toleratedFutureMs } from '../time/timeline';
import { Units } from '../tables/units';
import { ApiError, Domain, Region, domains, isRegion, region, tables, times } from '../wire/api';
import { Ahead } from './ahead';
import { AddressBar, stateOfAddress, timeThatIsNone } from './address_bar';
import { element } from './dom';
import { Loader } from './loader';
import { rememberUnits } from './remembered';
import { ServerState } from './server_state';
import { TableBook } from './table_book';
import { texts } from './texts';

const soonTimes = 500; // of a domain, before all others
const mostTimes = 10000; // that the server tells at once
// Greatest time from a grid to the instants of regions that it is in: a volume takes some minutes, and the
// instants are at most 15 minutes away.
const farthestMadeMs = 30 * 60 * 1000;

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
    framesASecond = 4; // of playback
    // Fetches what else a picture of `next` needs. Until it has come, the one before stays. Null: it is there.
    alongside: (next: Shown, isAhead: boolean) => Promise<void> | null = () => null;
    isShownWhole: () => boolean = () => true; // the picture has all of what is shown
    isGraphicsLost = false; // nothing can be drawn
    readonly server = new ServerState(() => this.tell('notice'));
    missed = ''; // what was asked for and is not there
    private missedTime = ''; // a time of that
    readonly timeline = new Timeline(
        this.state.time === 'latest',
        () => this.state.betweenS,
        () =>
            Math.max(
                this.server.nowMs + toleratedFutureMs,
                Date.parse(this.domain?.moments.find((one) => one.moment === this.state.moment)?.newest ?? '') || 0,
            ),
    );
    private heard = new Map<Happening, (() => void)[]>();
    private coming = 0; // times that are not shown yet
    private ticking = 0; // the timer of playback
    private readonly ahead = new Ahead(this);
    private addressBar = new AddressBar(() => addressOf(this.state));
    private turn = 0; // of what is to be shown
    private choices = 0; // of domains and moments
    private askedDomain = ''; // which may not be there, as the moment
    private askedMoment = '';
    private unreadTime = timeThatIsNone(); // of the address

    constructor(readonly loader: Loader) {}

    get player(): PlayerState {
        return this.timeline.player;
    }
    private set player(player: PlayerState) {
        this.timeline.player = player;
    }

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
        // fetch() throws a TypeError if there was no answer at all.
        if (error instanceof TypeError) {
            this.server.isBehind = true;
            return this.say(texts.notice.noServer);
        }
        const isGone = error instanceof ApiError && (error.status === 404 || error.status === 410);
        this.say(isGone ? texts.notFound : texts.failed(error instanceof Error ? error.message : String(error)));
    }
    // If what failed is not wanted any more, the page says only that the server does not answer.
    private failed(error: unknown, isWanted: boolean): void {
        if (isWanted || error instanceof TypeError) this.fail(error);
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

    // The view was changed by a panel.
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
    // Whoever gets the link sees what is shown now, even if this page follows the newest.
    get link(): string {
        this.addressBar.write();
        const { shown, state } = this;
        const isShown = shown?.domain === state.domain && shown.moment === state.moment;
        const time = isShown ? shown.time : (this.timeline.now ?? state.time);
        return new URL(`#${addressOf({ ...state, time })}`, location.href).href;
    }

    // The address was changed by hand, or by going back. A picture that came meanwhile may have written another one.
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
    // News were lost: all lists are asked for anew, and any grid may have been made again.
    async catchUp(): Promise<void> {
        if (!this.book || this.domains.length === 0) return this.begin();
        await this.findDomains();
        this.tell('choices');
        const { state, shown } = this;
        this.loader.forgetAll(() => true);
        if (this.isOnMap) return;
        if (!shown) return this.choose(state.domain, this.askedMoment);
        // Ask again for what the user chose while there was no answer.
        if (shown.domain !== state.domain || shown.moment !== state.moment)
            return this.choose(state.domain, this.askedMoment);
        if (isRegion(state.domain)) return this.takeNewsOfSite(undefined);
        await this.takeNews(state.domain, state.moment, shown.time, '', mostTimes);
    }
    private miss(text: string, time = ''): void {
        [this.missed, this.missedTime] = [text, time];
        this.tell('notice');
    }

    // A region is a domain once its sites and times are known. Errors: what the server says of its box.
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
    // Going back in the browser leads here again.
    goToMap(): void {
        if (!this.isOnMap) this.addressBar.write();
        history.pushState(null, '', '#');
        this.openMap();
    }
    // From the map into a domain.
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
        return this.showChosen();
    }
    // Asks for the times of the domain and moment that were chosen, and shows the wanted one of them.
    private async showChosen(): Promise<void> {
        this.tell('choices');
        this.say(texts.loading);
        this.stayWhoPaused();
        const choice = ++this.choices;
        try {
            const soon = await times(this.state.domain, this.state.moment, soonTimes);
            if (choice !== this.choices) return;
            this.timeline.forget();
            this.timeline.take(soon.times);
            const { time } = this.state;
            // A time before those of the first answer is looked for among all.
            const isOlder = soon.more && !this.player.follows && Date.parse(time) < Date.parse(soon.times[0] ?? '');
            if (isOlder) await this.findOlder();
            if (!this.player.follows && !this.timeline.find(time))
                this.miss([this.missed, texts.notice.otherTime(time)].filter(Boolean).join(' '), time);
            await this.showTime(this.player.follows ? undefined : time);
            if (soon.more && !isOlder) await this.findOlder();
        } catch (error) {
            if (choice === this.choices) this.fail(error);
        }
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
    // If the user does not follow any more, but was shown no other time yet, keeps the time of the player.
    private stayWhoPaused(): void {
        if (this.player.follows || this.state.time !== 'latest') return;
        const now = this.timeline.now;
        if (now === undefined) this.player = { ...this.player, follows: true };
        else this.state.time = now;
    }

    // If the time that a user looks at was evicted, moves to the nearest, and the page says so. If the user
    // waits for a time that was missed, moves to the time that is nearest to it now.
    private takeNewTimes(stored: string[]): void {
        const [now, missedTime] = [this.timeline.now, this.missedTime];
        this.timeline.take(stored);
        const { at: shown, times: all, follows, isPlaying } = this.player;
        if (now === undefined || shown < 0 || follows || isPlaying) return;
        if (missedTime !== '' && this.timeline.find(missedTime)) this.miss('');
        else if (missedTime === '' && !all.includes(now)) this.miss(texts.notice.otherTime(now), now);
    }
    // The timeline has every grid; the older ones come after the first picture.
    private async findOlder(): Promise<void> {
        const { domain, moment } = this.state;
        const isLeft = this.whetherLeft();
        for (let more = true; more;) {
            const older = await times(domain, moment, mostTimes, this.timeline.stored[0]);
            if (isLeft()) return;
            more = older.more && older.times.length > 1;
            this.timeline.take([
                ...older.times.filter((time) => time < this.timeline.stored[0]!),
                ...this.timeline.stored,
            ]);
            this.tell('time');
        }
    }

    // Frames between volumes every so many seconds; 0: the volumes alone.
    async setBetween(seconds: number): Promise<void> {
        this.miss('');
        const shown = this.timeline.now;
        this.state.betweenS = seconds;
        this.timeline.take(this.timeline.stored);
        if (shown !== undefined && !this.player.follows) this.timeline.find(shown);
        await this.showTime();
    }

    // Tells later whether another domain or moment was chosen.
    whetherLeft(): () => boolean {
        const { domain, moment } = this.state;
        return () => domain !== this.state.domain || moment !== this.state.moment;
    }
    // Shows the time of the timeline. If its grid is not there, a step goes on to the next time in the
    // direction of `by`; else shows the time nearest to the wanted one.
    private async showTime(nearest?: string, by = 0): Promise<void> {
        const time = this.timeline.now;
        this.tell('time');
        if (time === undefined) return this.say(texts.notFound);
        const wanted = nearest ?? time;
        const [turn, isLeft] = [++this.turn, this.whetherLeft()];
        const isLate = () => turn !== this.turn || this.timeline.now !== time || isLeft();
        ++this.coming;
        try {
            const loaded = await this.load(time);
            // Another version of the same grid may be on its way.
            if (isLate()) return;
            const next = this.shownOf(time, loaded);
            await this.alongside(next, false);
            if (!isLate()) this.take(next);
        } catch (error) {
            const wasLate = isLate();
            const index = this.player.at;
            if (!this.leaveOut(time, error, isLeft)) return this.failed(error, !wasLate);
            const stays = !wasLate && !this.player.follows && !this.player.isPlaying;
            if (stays && by !== 0) this.player = at(this.player, by > 0 ? index : index - 1);
            else if (stays) this.timeline.find(wanted);
            if (stays && by === 0 && this.missedTime === '')
                this.miss([this.missed, texts.notice.otherTime(time)].filter(Boolean).join(' '), time);
            if (this.timeline.now !== undefined) await this.showTime(stays ? wanted : undefined, by);
        } finally {
            --this.coming;
        }
    }
    shownOf(time: string, loaded: LoadedGrid): Shown {
        const { domain, moment } = this.state;
        return {
            key: Loader.key(domain, moment, time),
            loaded,
            domain,
            moment,
            time,
            isBetween: this.timeline.isBetween(time),
        };
    }
    load(time: string): Promise<LoadedGrid> {
        return this.loader.load(this.state.domain, this.state.moment, time, this.timeline.isBetween(time));
    }
    // Leaves out a time whose grid is gone. Returns false if the time stays, so that the caller tells the failure.
    leaveOut(time: string, error: unknown, isLeft: () => boolean): boolean {
        // The server also answers 410 for a grid in parts that was made again meanwhile.
        const isGone =
            error instanceof ApiError &&
            (error.status === 404 || (error.status === 410 && !error.message.includes('made again')));
        if (isLeft() || !isGone || !this.timeline.leaveOut(time)) return false;
        this.tell('time');
        return true;
    }

    private take(shown: Shown): void {
        const { book } = this;
        // The colors stay while a loop plays. The halved grid of a grid in parts tells whether it shows clear air.
        const isOther = this.shown?.domain !== shown.domain || !this.player.isPlaying;
        if (book && isOther)
            book.isClearAir = shown.moment === 'REF' && (shown.loaded.stream?.isClear ?? isClearAir(shown.loaded.grid));
        this.shown = shown;
        this.unreadTime = '';
        this.state.time = this.player.follows ? 'latest' : shown.time;
        this.ahead.load();
        this.tell('shown');
        this.changed();
    }

    restore(): void {
        this.tell('restored');
        if (this.shown) this.take(this.shown);
    }

    // -- time

    goTo(index: number): void {
        this.miss('');
        this.player = at(this.player, index);
        void this.showTime();
    }
    step(by: number): void {
        this.miss('');
        this.player = stepped(this.player, by);
        void this.showTime(undefined, by);
    }
    follow(): void {
        this.miss('');
        this.timeline.follow();
        void this.showTime();
    }
    play(): void {
        this.miss('');
        this.player = { ...this.player, isPlaying: !this.player.isPlaying, follows: false };
        this.tell('time');
        if (this.player.isPlaying) {
            this.ahead.load();
            this.tick();
        }
    }

    private tick(): void {
        if (!this.player.isPlaying) return;
        const { player, waitsFor } =
            this.coming === 0 && this.isShownWhole()
                ? advanced(this.player, (time) => this.ahead.has(time))
                : { player: this.player, waitsFor: null };
        if (this.coming > 0) this.say(texts.waiting(this.timeline.now ?? ''), false);
        if (waitsFor !== null) {
            this.say(texts.waiting(waitsFor));
            const isLeft = this.whetherLeft();
            this.ahead
                .take(waitsFor, false)
                .catch(
                    (error: unknown) =>
                        this.leaveOut(waitsFor, error, isLeft) ||
                        this.failed(error, this.player.isPlaying && !isLeft()),
                );
        } else if (player !== this.player) {
            this.player = player;
            void this.showTime();
        }
        window.clearTimeout(this.ticking);
        this.ticking = window.setTimeout(() => this.tick(), 1000 / this.framesASecond);
    }
    // Keeps playback in a part of the times, one end of which is now; null plays all times.
    setLoop(end: 'from' | 'to' | null): void {
        this.player = end ? looped(this.player, end) : { ...this.player, loop: null };
        this.tell('time');
    }

    private isPartOfShown(domain: string | undefined): boolean {
        const own = this.domains.find((one) => one.domain === this.state.domain) as Region | undefined;
        return (
            domain === this.state.domain ||
            (isRegion(this.state.domain) && (own?.moments.some((one) => one.sites.includes(domain ?? '')) ?? false))
        );
    }
    // Takes a new volume of a site of the shown region: any instant near it may have become another one. If
    // `volume` is undefined, any instant at all may have.
    private async takeNewsOfSite(volume: string | undefined): Promise<void> {
        const { domain, moment } = this.state;
        const isLeft = this.whetherLeft();
        await this.findRegion(domain);
        if (isLeft()) return;
        const isNear = (time: string) =>
            volume === undefined || Math.abs(Date.parse(time) - Date.parse(volume)) <= farthestMadeMs;
        const of = `${domain}/${moment}/`;
        this.loader.forgetAll((key) => key.startsWith(of) && isNear(key.slice(of.length)));
        const stored = (await times(domain, moment, soonTimes)).times;
        if (isLeft()) return;
        this.takeNewTimes(stored);
        await this.showTime();
    }

    // The server has other times now; `changedTime` is that of a grid that was made again, `oldest` the first that is
    // left after others were evicted.
    async takeNews(
        domain: string | undefined,
        moment: string | undefined,
        changedTime: string | undefined,
        oldest = '',
        most = soonTimes,
    ): Promise<void> {
        if (this.domains.length === 0) {
            if (!this.book) return this.begin();
            await this.findDomains();
            if (this.domain) await this.choose(this.state.domain, this.state.moment);
            return;
        }
        // A moment may come after the others of its station.
        const isKnown = this.domains.some(
            (one) =>
                one.domain === domain && (moment === undefined || one.moments.some((own) => own.moment === moment)),
        );
        if (domain !== undefined && !domain.includes('.') && !isKnown) {
            await this.findDomains();
            this.tell('choices');
        }
        const isOfShown = domain === this.state.domain && moment === this.state.moment;
        const isOld = changedTime
            ? outdatedBy(
                  `${domain}/${moment}`,
                  changedTime,
                  isOfShown ? this.timeline.stored : [],
                  `${this.state.domain}/${this.state.moment}`,
              )
            : () => false;
        this.loader.forgetAll(isOld);
        // A surface may be that of another moment.
        const isOfSurface = moment !== undefined && moment === this.state.layers.surface?.moment;
        if (!this.isPartOfShown(domain) || (moment !== this.state.moment && !isOfSurface)) return;
        if (domain !== this.state.domain) return this.takeNewsOfSite(changedTime);
        if (moment !== this.state.moment) return changedTime === this.shown?.time ? this.showTime() : undefined;
        const before = this.timeline.now;
        const { times: newest, more } = await times(domain, moment, most);
        if (domain !== this.state.domain || moment !== this.state.moment) return;
        // If the server has no more, it has evicted the older ones.
        this.takeNewTimes([
            ...this.timeline.stored.filter((time) => more && time >= oldest && time < newest[0]!),
            ...newest,
        ]);
        const now = this.timeline.now;
        const isOfNow = now !== undefined && isOld(Loader.key(domain, moment, now));
        // After a failure the page may wait for another time than that of the picture.
        if (now !== before || now !== this.shown?.time || isOfNow || now === changedTime) await this.showTime();
        else this.tell('time');
    }
}
