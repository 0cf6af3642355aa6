// Holds the state of the page: the view, the chosen domain and moment, and the shown grid. Panels and pointers change
// the state through methods of App, and App tells them what happened. Showing loads the wanted time, Playback chooses
// it, and News handles news of the server.

import { namedView } from '../camera/controls';
import { Camera } from '../camera/geometry';
import { LoadedGrid } from '../atlas/loaded_grid';
import { CutNumber } from '../fields/sweep_choice';
import { Stance, elsewhere, switched } from '../scene/flat_view';
import { Layers } from '../scene/layers';
import { PaneView, withLayers, withPanes } from '../scene/panes';
import { ViewState, addressOf, usualState } from '../scene/view_state';
import { ColorTable } from '../wire/color_tables';
import { PlayerState, stopped } from '../time/player';
import { Timeline, toleratedFutureMs } from '../time/timeline';
import { Units } from '../tables/units';
import { ApiError, Domain, domains, isRegion, region, tables } from '../wire/api';
import { AddressBar, namesView, stateOfAddress, timeThatIsNone } from './address_bar';
import { element } from './dom';
import type { LayerMaker } from './layer_maker';
import { Loader } from './loader';
import { News } from './news';
import { Playback } from './playback';
import { rememberUnits } from './remembered';
import { ServerState } from './server_state';
import { Showing } from './showing';
import { TableBook } from './table_book';
import { texts } from './texts';

// Kinds of changes, and what changes:
//   choices   the domain, or its list of moments
//   shown     the shown grid
//   view      how the grid is shown
//   camera    the camera
//   units     the units of texts
//   time      the list of times, or the wanted time
//   restored  the WebGL context, which lost all its data
//   map       whether the map of all stations is open
//   cells     data of layers have come
//   notice    messages about the server, the radars, or data that the user asked for
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

// The camera, heights and opacity with which the page first shows a domain.
type Look = Pick<ViewState, 'camera' | 'exaggeration' | 'opacity'>;
const usualLook: Look = {
    camera: usualState.camera,
    exaggeration: usualState.exaggeration,
    opacity: usualState.opacity,
};

export class App {
    state: ViewState = stateOfAddress();
    domains: Domain[] = [];
    book: TableBook | null = null; // null until the server's tables have come
    shown: Shown | null = null;
    isOnMap = false; // the map of all stations is open
    // Fetches the data that a picture of `next` needs besides its grid. Returns a promise that resolves when the data
    // have come, or null if they are here. The shown picture stays until then.
    alongside: (next: Shown, isAhead: boolean) => Promise<void> | null = () => null;
    // Returns the grids that the other panes show beside `next`, the grid of the active pane.
    beside: (next: Shown) => readonly (Shown | null)[] = () => [];
    isDrawing: () => boolean = () => false; // returns true while a picture is being drawn
    isShownWhole: () => boolean = () => true; // returns true if all layers of the picture have come
    repeats: (pane?: number) => ReturnType<LayerMaker['repeats']> = () => null;
    nextCut: CutNumber | undefined = undefined; // number of the sweep in the next picture; undefined: as in this one
    isGraphicsLost = false; // the WebGL context is lost
    readonly server = new ServerState(() => this.tell('notice'));
    missed = ''; // message about what the user asked for and the server does not have
    missedTime = ''; // time that `missed` names; empty if it names none
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
    choices = 0; // counts choices of a domain and moment, to recognize answers to an older choice
    askedMoment = ''; // moment of the last call of choose(); the server may not have it
    private askedDomain = '';
    unreadTime = timeThatIsNone(); // time parameter of the address if it is not a time
    wantsFit = !namesView(); // the next picture may get a view that suits its storms (page/fitting.ts)
    private first = usualLook; // the look in 3D to which resetView() leads back
    private otherStance: Stance | null = null; // of 3D while the page shows 2D, and of 2D while it shows 3D
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
        this.say(
            isGone
                ? texts.notFound(this.state.domain, this.state.moment)
                : texts.failed(error instanceof Error ? error.message : String(error)),
        );
    }

    // -- the view

    get table(): ColorTable | undefined {
        return this.book?.of(this.state, this.state.moment);
    }
    // Returns the color table of the shown moment, which stays in the picture until another moment has come.
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
    // Shows these panes. The active one must show the moment of `shown`, unless its grid is loaded next.
    usePanes(all: readonly PaneView[], active: number): void {
        Object.assign(this.state, withPanes(all, active));
        this.changed();
        void this.choose(this.state.domain, this.state.moment);
    }
    // Changes the layers of all panes.
    setLayers(change: (layers: Layers, index: number) => Layers): void {
        const { state } = this;
        Object.assign(state, withPanes(withLayers(state, change), state.active));
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
        this.state.camera = this.state.isFlat ? namedView(camera, 'top') : camera;
        this.addressBar.writeSoon();
        this.tell('camera');
    }
    // Returns true if camera, heights and opacity are those with which the page first shows a grid.
    get isFirstView(): boolean {
        const { camera, exaggeration, opacity, isFlat } = this.state;
        const { first } = this;
        const isFirstEcho = isFlat || (exaggeration === first.exaggeration && opacity === first.opacity);
        return isFirstEcho && JSON.stringify(camera) === JSON.stringify(this.firstCamera);
    }
    private get firstCamera(): Camera {
        return this.state.isFlat ? namedView(usualState.camera, 'top') : { ...this.first.camera };
    }
    // Takes a look that suits the next picture, unless the user has turned the camera meanwhile.
    fit(look: Look): void {
        if (this.state.isFlat || !this.isFirstView) return;
        this.first = look;
        Object.assign(this.state, look);
    }
    resetView(): void {
        if (!this.state.isFlat) {
            this.state.exaggeration = this.first.exaggeration;
            this.state.opacity = this.first.opacity;
        }
        this.moved(this.firstCamera);
        this.changed();
    }
    // Switches to 2D or 3D, and to the camera and the layers that were there last.
    showFlat(isFlat: boolean): void {
        if (isFlat === this.state.isFlat) return;
        const before = this.state;
        this.nextCut = undefined;
        this.state = switched(before, isFlat, this.otherStance);
        this.otherStance = before;
        this.tell('camera');
        this.changed();
    }
    // Returns a link to what is shown now, even if this page follows the newest.
    get link(): string {
        this.addressBar.write();
        const { shown, state } = this;
        const isShown = shown?.domain === state.domain && shown.moment === state.moment;
        const time = isShown ? shown.time : (this.timeline.now ?? state.time);
        return new URL(`#${addressOf({ ...state, time })}`, location.href).href;
    }

    // Shows the view of an address that the user typed or went back to. Pass the address of the event, because the page
    // may write another address before it handles the event.
    takeAddress(hash: string): void {
        const [next, unreadTime] = [stateOfAddress(hash), timeThatIsNone(hash)];
        if (next.domain === '' && this.domains.length > 1) return this.openMap();
        if (!this.isOnMap && unreadTime === '' && addressOf(next) === addressOf(this.state)) return;
        [this.state, this.unreadTime] = [next, unreadTime];
        [this.wantsFit, this.first] = [!namesView(hash), usualLook];
        this.otherStance = null;
        this.tell('units');
        this.player = { ...this.player, follows: next.time === 'latest', isPlaying: false };
        void this.choose(next.domain, next.moment);
    }

    // -- the shown grid

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
        // Sites that reach the region may have come since it was asked for.
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
    // Adds a message that the server does not have a time.
    missTime(time: string): void {
        this.miss([this.missed, texts.notice.otherTime(time)].filter(Boolean).join(' '), time);
    }

    // Asks the server for a region, and adds it to the domains. Errors are as in region().
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
        if (!this.state.isFlat && this.isFirstView) {
            Object.assign(this.state, usualLook);
            this.wantsFit = true;
        }
        this.first = usualLook;
        Object.assign(this.state, elsewhere(this.state));
        this.otherStance &&= elsewhere(this.otherStance);
        await this.choose(domain, this.state.moment);
    }

    // Shows a moment of a domain. If the server does not have the domain, opens the map of all stations, or shows the
    // only domain if there is just one. If the domain does not have the moment, shows its first moment. A message tells
    // what is missing.
    async choose(domain: string, moment: string): Promise<void> {
        this.miss('');
        this.nextCut = undefined;
        [this.askedDomain, this.askedMoment] = [domain, moment];
        if (isRegion(domain) && !this.domains.some((one) => one.domain === domain)) {
            const choice = ++this.choices;
            try {
                await this.findRegion(domain);
            } catch (error) {
                if (choice !== this.choices) return;
                // Keep the region as the domain, so that it is asked for again when the server answers.
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
        // Drop the threshold if the moment changes, because the threshold is in the unit of the old moment.
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
    // Chooses the shown domain and moment again. Drops the threshold if the moment changes.
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
