// A pane of the picture: its moment, layers and grid. All panes have the domain, the time and the camera of the page.
// The active pane has the moment and the grid of App.

import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { DrawnLayers } from '../renderer/layer_passes';
import { ViewState } from '../scene/view_state';
import { ColorTable } from '../wire/color_tables';
import { Domain } from '../wire/api';
import { App, Shown } from './app';
import { LayerMaker, LayerShare, LayerSource } from './layer_maker';
import { Loader } from './loader';
import { Windows } from './windows';

export class Pane implements LayerSource {
    readonly windows: Windows;
    readonly layers: LayerMaker;
    drawn: DrawnLayers | null = null; // layers of the last picture
    private own: Shown | null = null; // the grid while the pane is not active
    private missing = new Set<string>(); // keys of grids that failed

    constructor(
        private app: App,
        readonly index: number,
        share: LayerShare,
    ) {
        this.windows = new Windows(
            app.loader.decoder,
            () => app.loader.budget.bytesOfPane,
            () => app.cellsCame(),
            (error) => this.fail(error),
        );
        this.layers = new LayerMaker(this, this.windows, share, () => app.cellsCame());
    }

    get isActive(): boolean {
        return this.app.state.active === this.index;
    }
    get state(): ViewState {
        const { state } = this.app;
        return this.isActive ? state : { ...state, ...state.panes[this.index] };
    }
    get shown(): Shown | null {
        return this.isActive ? this.app.shown : this.own;
    }
    get shownTable(): ColorTable | undefined {
        return this.shown ? this.app.book?.of(this.state, this.shown.moment) : undefined;
    }
    get unit(): string {
        const moment = this.shown?.moment ?? this.state.moment;
        return this.domain?.moments.find((one) => one.moment === moment)?.units ?? '';
    }
    get domain(): Domain | undefined {
        return this.app.domain;
    }
    get loader(): Loader {
        return this.app.loader;
    }
    get nextCut(): App['nextCut'] {
        return this.app.nextCut;
    }
    fail(error: unknown): void {
        this.app.fail(error);
    }

    // Returns true if the server lacks the pane's moment at the shown time.
    get isAbsent(): boolean {
        const { shown } = this.app;
        return !this.isActive && shown !== null && (!this.isInDomain || this.missing.has(this.keyAt(shown)));
    }
    private get isInDomain(): boolean {
        return this.domain?.moments.some(({ moment }) => moment === this.state.moment) ?? false;
    }
    // Returns true if the picture of the pane has all layers, or if the server lacks the pane's moment.
    get isComplete(): boolean {
        const { shown, state } = this;
        if (!shown) return this.isAbsent;
        return !this.layers.isWaiting && shown.moment === state.moment && shown.domain === state.domain;
    }

    // -- the grid while the pane is not active

    private keyAt({ domain, time }: Shown): string {
        return Loader.key(domain, this.state.moment, time);
    }
    // Returns what the pane shows beside `next`, the grid of the active pane; null if there is no such grid.
    beside(next: Shown): Shown | null {
        const key = this.keyAt(next);
        const loaded = this.loader.find(key);
        if (!loaded) return null;
        if (this.own?.key === key && this.own.loaded === loaded) return this.own;
        return { ...next, key, loaded, moment: this.state.moment };
    }
    // Keeps what the pane shows when it becomes active or inactive.
    keep(shown: Shown | null): void {
        this.own = shown;
    }

    // Fetches the grid beside `next` and the data of its layers. Returns null if all of them are here, or if the
    // server lacks them. `geometryOf` returns the camera for a grid.
    alongside(next: Shown, isAhead: boolean, geometryOf: (loaded: LoadedGrid) => ViewGeometry): Promise<void> | null {
        const { moment } = this.state;
        if (!this.isInDomain) return null;
        const key = this.keyAt(next);
        const layersOf = (): Promise<void> | null => {
            const shown = this.beside(next);
            return shown && this.layers.alongside(shown, isAhead, geometryOf(shown.loaded));
        };
        if (this.loader.has(key)) return layersOf();
        if (isAhead && this.missing.has(key)) return null;
        return this.loader.load(next.domain, moment, next.time, next.isBetween).then(
            async () => {
                this.missing.delete(key);
                await layersOf();
            },
            () => void this.missing.add(key),
        );
    }
}
