// Makes the layers that the renderer draws: cuts of the shown grid, a surface of another moment's grid, and a sweep of
// the volume. Keeps each until its inputs change.

import { ViewGeometry } from '../camera/geometry';
import { airOf } from '../fields/air';
import { fallsOf } from '../fields/falls';
import { levelsAbout, maximumField, planeField } from '../fields/flat_field';
import { Section, cutSection } from '../fields/section';
import { mixingOf } from '../fields/status_rule';
import { CutNumber, cutOf, kindOf, nearestSite, repeatsOf } from '../fields/sweep_choice';
import { DrawnLayers, DrawnSurface } from '../renderer/layer_passes';
import { LoadedGrid } from '../atlas/loaded_grid';
import { Cells, extentOf, placingOf } from '../scene/grid_box';
import {
    Layers,
    echoLayers,
    isBelow,
    leastRotation,
    rotationMoment,
    sweepMoment,
    sweepQuality,
    usualLayers,
    veilsFolded,
} from '../scene/layers';
import { Place, Plane, planeOf } from '../earth/projection';
import { ColorTable } from '../wire/color_tables';
import { heightText, valueText } from '../tables/units';
import { Looks, looksOf } from '../tables/looks';
import { SweepRow, isAbsent } from '../wire/api';
import { PackedGrid, valueOf } from '../wire/packed_grid';
import { App, Shown } from './app';
import { Loader } from './loader';
import { PlacedSweep, SweepStore, WantedSweep } from './sweep_store';
import { texts } from './texts';
import { Windows } from './windows';

const sectionColumns = 480;
const sectionRows = 192;
const againAfterMs = 10_000; // after a sweep, or a grid of another moment, has failed

// What all panes share: sweeps, and the program of rotation.
export interface LayerShare {
    store: SweepStore;
    makeRotation: ((of: LoadedGrid) => LoadedGrid) | null; // null until its program has come
    layerCame: (() => void)[]; // called when a layer has come or failed, so that told() has changed
}

// A pane whose layers are made.
export type LayerSource = Pick<App, 'state' | 'shown' | 'shownTable' | 'domain' | 'loader' | 'nextCut' | 'fail'>;

// Keeps the last value of each name, and its inputs.
class Kept {
    private held = new Map<string, { of: readonly unknown[]; value: unknown }>();

    take<T>(name: string, of: readonly unknown[], make: () => T): T {
        const known = this.held.get(name);
        if (known?.of.length === of.length && known.of.every((part, i) => part === of[i])) return known.value as T;
        const value = make();
        this.held.set(name, { of, value });
        return value;
    }
}

const hasSameCells = (a: PackedGrid, b: PackedGrid): boolean =>
    a.nx === b.nx &&
    a.ny === b.ny &&
    a.nz === b.nz &&
    a.spacing === b.spacing &&
    a.levelsM.every((level, z) => level === b.levelsM[z]);

// Moves a section onto the plane of the grid that is shown.
function movedBy(section: Section, [x, y]: Plane): Section {
    return { ...section, ends: section.ends.map(([east, north]): Plane => [east + x, north + y]) };
}

export class LayerMaker {
    private kept = new Kept();
    private comingOthers = new Set<string>(); // keys of grids of another moment that are being loaded
    private missingOthers = new Map<string, { at: number; error: unknown }>(); // when and why such grids failed
    private toldSweep = ''; // key of the sweep for which layerCame() was last called
    private lastSweep: { of: LoadedGrid; moment: string; key: string; sweep: PlacedSweep } | null = null;
    private askedSweep = ''; // key of the sweep that is being loaded

    constructor(
        private pane: LayerSource,
        private windows: Windows,
        private shared: LayerShare,
        private came: () => void,
    ) {}

    // Returns true if something that a layer needs has not come yet.
    get isWaiting(): boolean {
        const { shown, state } = this.pane;
        if (!shown) return false;
        const waitsForSweep = state.layers.sweepDeg !== null && !this.isSweepSettled(this.sweepKey(shown));
        const waitsForOther = this.othersOf(shown).some(({ key }) => this.comingOthers.has(key));
        return waitsForSweep || waitsForOther || this.windows.isWaiting;
    }
    // Returns true if the sweep has come or failed. The drawn sweep has come, even if `sweeps` has no room to keep it.
    private isSweepSettled(key: string): boolean {
        return this.lastSweep?.key === key || this.shared.store.sweeps.isSettled(key);
    }

    // Fetches the data of layers that must come before `next` is shown: a sweep, the grid of another moment, and
    // windows. Returns null if all of them are here. `geometry` is the camera of the next picture.
    alongside(next: Shown, isAhead: boolean, geometry: ViewGeometry): Promise<void> | null {
        const { sweepDeg } = this.pane.state.layers;
        const waits: Promise<unknown>[] = [];
        if (sweepDeg !== null && this.shared.store.sweeps.isNeeded(this.sweepKey(next)))
            waits.push(this.takeSweep(next, isAhead));
        for (const other of next.loaded.stream ? [] : this.othersOf(next))
            if (!this.pane.loader.has(other.key) && !this.isMissing(other.key)) waits.push(this.takeOther(next, other));
        // Fetch windows for the next grid only, because there is room for the windows of one grid.
        const windows = isAhead
            ? null
            : this.windows.next(next.loaded, () => this.cellsOf(next.loaded, geometry, false));
        if (windows) waits.push(windows);
        return waits.length > 0 ? Promise.all(waits).then(() => undefined) : null;
    }
    // Finds the cells for each kind of layer, and releases windows that no layer needs.
    private cellsOf(
        loaded: LoadedGrid,
        geometry: ViewGeometry,
        isMoving: boolean,
    ): { seen: Cells | null; lit: Cells | null; crossed: Cells | null } {
        const { layers } = this.pane.state;
        const { section } = layers;
        const isFlat =
            layers.planeM !== null ||
            layers.hasMaximum ||
            layers.hasHaze ||
            veilsFolded(layers, this.pane.shown?.moment ?? '');
        return {
            seen: this.needed('layers', isFlat, () => this.windows.seen(loaded, 'layers', geometry, isMoving)),
            lit: this.needed('light', layers.isLit, () => this.windows.seen(loaded, 'light', geometry, isMoving)),
            crossed: this.needed('section', section !== null, () => section && this.windows.along(loaded, section)),
        };
    }

    // Makes all layers; null if only the volume is drawn. While the view moves, asks for no new windows that depend on
    // the view.
    make(geometry: ViewGeometry, isMoving: boolean): DrawnLayers | null {
        const { shown, shownTable: table, state } = this.pane;
        const { layers } = state;
        const isUsual = (Object.keys(usualLayers) as (keyof Layers)[]).every(
            (name) => name === 'hasVolume' || layers[name] === usualLayers[name],
        );
        if (!shown || !table) return this.nothing();
        const hasFolded = veilsFolded(layers, shown.moment);
        if (isUsual && !hasFolded) return this.nothing();
        const { loaded } = shown;
        const { seen, lit, crossed } = this.cellsOf(loaded, geometry, isMoving);
        return {
            plane: seen && this.planeOf(seen, shown.moment, layers.planeM),
            section: crossed && layers.section && this.sectionOf(crossed, shown.moment, layers.section),
            surface: this.surfaceOf(shown, layers),
            maximum: seen && layers.hasMaximum ? this.maximumOf(seen) : null,
            sweep: this.sweepOf(shown)?.drawn ?? null,
            crop: layers.crop,
            rotation: layers.hasRotation ? this.rotationOf(shown) : null,
            falls: lit && this.fallsOf(lit, shown, table),
            air: seen && (layers.hasHaze || hasFolded) ? this.airOf(seen, shown) : null,
            hasHaze: layers.hasHaze,
            hasFolded,
            mixes: mixingOf(shown.moment) === 'mean',
            folded: table.range_folded,
            looks: this.looksOf(table, state.least),
        };
    }

    private nothing(): null {
        for (const purpose of ['layers', 'light', 'section'] as const) this.windows.release(purpose);
        return null;
    }
    private needed(purpose: 'layers' | 'light' | 'section', isNeeded: boolean, find: () => Cells | null): Cells | null {
        if (isNeeded) return find();
        this.windows.release(purpose);
        return null;
    }

    private planeOf(cells: Cells, moment: string, heightM: number | null): DrawnLayers['plane'] {
        if (heightM === null) return null;
        const field = this.kept.take('plane', [cells.grid, heightM], () => planeField(cells.grid, moment, heightM));
        return field && this.kept.take('drawn plane', [field], () => ({ field, heightM, extent: extentOf(cells) }));
    }
    private maximumOf(cells: Cells): DrawnLayers['maximum'] {
        return this.kept.take('maximum', [cells.grid], () => ({
            field: maximumField(cells.grid),
            extent: extentOf(cells),
        }));
    }
    private sectionOf({ grid, middle }: Cells, moment: string, ends: readonly [Place, Place]): Section {
        return this.kept.take('section', [grid, ends[0], ends[1]], () =>
            movedBy(cutSection(grid, moment, ends[0], ends[1], sectionColumns, sectionRows), middle),
        );
    }
    private airOf(cells: Cells, shown: Shown): DrawnLayers['air'] {
        return this.kept.take('air', [cells.grid], () => ({
            ...airOf(cells.grid),
            placing: placingOf(cells, shown.loaded.grid),
        }));
    }
    private fallsOf(cells: Cells, shown: Shown, table: ColorTable): DrawnLayers['falls'] {
        const make = () => ({
            ...fallsOf(cells.grid, shown.moment, table.stops[0]!.from),
            placing: placingOf(cells, shown.loaded.grid),
        });
        return this.kept.take('falls', [cells.grid, table], make);
    }
    private looksOf(table: ColorTable, least: number | null): Looks {
        return this.kept.take('looks', [table, least], () => looksOf(table, least ?? -1e9));
    }

    private surfaceOf(shown: Shown, { surface }: Layers): DrawnSurface | null {
        if (!surface) return null;
        const moment = surface.moment || shown.moment;
        const drawn = { value: surface.value, isBelow: isBelow(moment, surface.value) };
        const of = this.gridOf(shown, moment);
        return of && { ...drawn, of: of === shown.loaded ? null : of };
    }
    private rotationOf(shown: Shown): LoadedGrid | null {
        const make = this.shared.makeRotation;
        const of = make && this.gridOf(shown, rotationMoment);
        return of && this.kept.take('rotation', [of], () => make(of));
    }
    // Returns the grid of a moment at the shown time; null until it has come.
    private gridOf(shown: Shown, moment: string): LoadedGrid | null {
        if (moment === shown.moment) return shown.loaded;
        // A grid in parts has no grid of another moment, because the bricks of two grids would be needed at once.
        if (shown.loaded.stream) return null;
        const other = this.otherOf(shown, moment);
        const of = this.pane.loader.find(other.key);
        if (of) return hasSameCells(of.grid, shown.loaded.grid) ? of : null;
        if (!this.comingOthers.has(other.key) && !this.isMissing(other.key)) {
            this.comingOthers.add(other.key);
            void this.takeOther(shown, other).then(() => {
                this.comingOthers.delete(other.key);
                this.tellLayerCame();
                this.came();
            });
        }
        return null;
    }
    private tellLayerCame(): void {
        for (const act of this.shared.layerCame) act();
    }
    private otherOf({ domain, time }: Shown, moment: string): { key: string; moment: string } {
        return { key: Loader.key(domain, moment, time), moment };
    }
    // Returns the grids of other moments that layers need.
    private othersOf(shown: Shown): { key: string; moment: string }[] {
        const { surface, hasRotation } = this.pane.state.layers;
        return [surface?.moment || shown.moment, hasRotation ? rotationMoment : shown.moment]
            .filter((moment, i, all) => moment !== shown.moment && all.indexOf(moment) === i)
            .map((moment) => this.otherOf(shown, moment));
    }
    private isMissing(key: string): boolean {
        return performance.now() - (this.missingOthers.get(key)?.at ?? -Infinity) < againAfterMs;
    }
    private async takeOther(
        { domain, time, isBetween }: Shown,
        { key, moment }: { key: string; moment: string },
    ): Promise<void> {
        try {
            await this.pane.loader.load(domain, moment, time, isBetween);
        } catch (error) {
            this.missingOthers.set(key, { at: performance.now(), error });
            if (!isAbsent(error)) this.askLater();
        }
    }
    // Asks again for grids that were missing. Call when the server may have more moments.
    askAgain(): void {
        if (this.missingOthers.size === 0) return;
        this.missingOthers.clear();
        this.came();
    }
    // Causes another picture later. To draw it, the page asks again for the data that failed.
    private askLater(): void {
        window.setTimeout(this.came, againAfterMs + 1);
    }
    // Returns the reason why a layer of a moment's grid is not drawn; an empty text if it is drawn.
    private whyNot(shown: Shown, moment: string): string {
        if (moment === shown.moment) return '';
        const other = this.otherOf(shown, moment);
        if (shown.loaded.stream) return texts.surfaceLeftOut;
        const of = this.pane.loader.find(other.key);
        if (of) return hasSameCells(of.grid, shown.loaded.grid) ? '' : texts.layers.otherCells;
        if (!this.isMissing(other.key)) return texts.layers.otherComes;
        return isAbsent(this.missingOthers.get(other.key)?.error)
            ? texts.layers.noOther(other.moment)
            : texts.layers.otherFailed(other.moment);
    }

    // Returns all cuts of the volume whose sweep is drawn; null if no sweep is drawn.
    sweepRows(): SweepRow[] | null {
        const { shown } = this.pane;
        return shown && (this.sweepOf(shown)?.rows ?? null);
    }
    shownCut(): SweepRow | null {
        const { shown } = this.pane;
        return shown && (this.sweepOf(shown)?.row ?? null);
    }
    // Returns the sweeps of the shown tilt and volume in order of time, and the index of the wanted sweep. In 2D, they
    // are shown one after another. Returns null in 3D, or if the user has chosen another kind of cut.
    repeats(): { numbers: CutNumber[]; at: number } | null {
        const { shown, state } = this.pane;
        const { sweepDeg, sweepNumber } = state.layers;
        const rows = state.isFlat && state.betweenS === 0 ? this.sweepRows() : null;
        if (!shown || !rows || sweepDeg === null) return null;
        const moment = sweepMoment(state.layers, shown.moment);
        const [usual, wanted] = [null, sweepNumber].map((number) => cutOf(rows, moment, sweepDeg, number));
        const all = usual ? repeatsOf(rows, moment, usual) : [];
        const at = all.findIndex((row) => row.sweep === wanted?.sweep);
        return at < 0 ? null : { numbers: all.map((row) => (row === usual ? null : row.sweep)), at };
    }
    // Returns a sentence if nothing of the volume is visible. The sentence names the least visible value.
    private emptyTold({ moment, loaded: { grid, atlas } }: Shown): string[] {
        const { state, shownTable: table } = this.pane;
        const unit = this.pane.domain?.moments.find((one) => one.moment === moment)?.units ?? '';
        if (!table) return [];
        const least = Math.max(table.stops[0]!.from, table.extinction[0]!.value, state.least ?? -Infinity);
        const hasVisible = atlas.brickCount > 0 && valueOf(grid, atlas.greatest) >= least;
        return hasVisible ? [] : [texts.layers.noEchoFrom(valueText(least, unit, state.units))];
    }
    // Returns sentences about the layers other than the volume, and about hidden echo.
    told(): string[] {
        const { shown, state } = this.pane;
        const { layers, units } = state;
        if (!shown) return [];
        if (echoLayers(layers) === 0) return [texts.layers.hidden];
        const said = layers.hasVolume ? this.emptyTold(shown) : [];
        if (layers.hasVolume && state.opacity < 1) said.push(texts.layers.fainter(state.opacity));
        if (layers.crop && (layers.hasVolume || layers.surface))
            said.push(
                texts.layers.hiddenOutside(heightText(layers.crop.bottomM, units), heightText(layers.crop.topM, units)),
            );
        if (layers.hasFolded === false && veilsFolded({ ...layers, hasFolded: null }, shown.moment))
            said.push(texts.layers.hiddenFolded);
        if (state.least !== null)
            said.push(texts.layers.hiddenBelow(valueText(state.least, this.pane.shownTable?.unit ?? '', units)));
        if (layers.planeM !== null) {
            const isBeyond = levelsAbout(shown.loaded.grid.levelsM, layers.planeM) === null;
            said.push(
                texts.layers.planeTold(heightText(layers.planeM, units)) +
                    (isBeyond ? ` (${texts.layers.beyond})` : ''),
            );
        }
        if (layers.surface) {
            const moment = layers.surface.moment || shown.moment;
            const unit = this.pane.domain?.moments.find((one) => one.moment === moment)?.units ?? '';
            const value = valueText(layers.surface.value, unit, units);
            const why = this.whyNot(shown, moment);
            said.push(
                (isBelow(moment, layers.surface.value)
                    ? texts.layers.surfaceBelow(moment, value)
                    : texts.layers.surfaceFrom(moment, value)) + (why && ` (${why})`),
            );
        }
        if (layers.hasRotation) {
            const why = this.whyNot(shown, rotationMoment);
            said.push(texts.layers.rotationTold(leastRotation) + (why && ` (${why})`));
        }
        if (layers.hasMaximum) said.push(texts.layers.maximumTold);
        const leftOut = texts.layers.leftOut('', shown.loaded.grid.leftOut);
        if (leftOut) said.push(leftOut);
        if (layers.sweepDeg !== null) said.push(this.sweepTold(shown));
        return said;
    }
    private sweepTold(shown: Shown): string {
        const station = this.stationOf(shown);
        const found = this.sweepOf(shown);
        const isDealiased = sweepMoment(this.pane.state.layers, shown.moment) !== shown.moment;
        const say = isDealiased ? texts.layers.dealiasedSweepAt : texts.layers.sweepAt;
        if (found) {
            const { station: of, gates: drawn } = found.drawn;
            return say(of, cutText(found.row, found.rows)) + texts.layers.leftOut(', ', drawn.leftOut);
        }
        const error = this.shared.store.sweeps.errorOf(this.sweepKey(shown));
        if (error === undefined) return texts.layers.sweepComes(station);
        return isAbsent(error) ? texts.layers.noSweep(station) : texts.layers.sweepFailed(station);
    }
    // Returns the station whose sweep is drawn, which is the site nearest to the point that the view looks at. Returns
    // an empty text without sites.
    private stationOf({ loaded: { grid } }: Shown): string {
        const [x, y] = this.pane.state.camera.lookAtM ?? [0, 0];
        return nearestSite(grid.sites, planeOf(grid), [x, y])?.icao ?? '';
    }
    // Returns the sweep that a picture wants; null if the layer is off.
    private wantedSweep(shown: Shown): WantedSweep | null {
        const { layers } = this.pane.state;
        const { sweepDeg } = layers;
        if (sweepDeg === null) return null;
        return {
            station: this.stationOf(shown),
            moment: sweepMoment(layers, shown.moment),
            elevationDeg: sweepDeg,
            number: this.cutNumberOf(shown),
            quality: sweepQuality(layers),
        };
    }
    private sweepKey(shown: Shown): string {
        const wanted = this.wantedSweep(shown);
        return wanted ? this.shared.store.keyOf(shown, wanted) : '';
    }
    private cutNumberOf(shown: Shown): CutNumber {
        const { nextCut, state } = this.pane;
        return shown === this.pane.shown || nextCut === undefined ? state.layers.sweepNumber : nextCut;
    }
    private takeSweep(shown: Shown, isAhead: boolean): Promise<void> {
        const wanted = this.wantedSweep(shown);
        return wanted ? this.shared.store.take(shown, wanted, isAhead) : Promise.resolve();
    }

    // Returns the sweep to draw. Until this sweep has come, returns the last drawn sweep of the same grid; null if
    // there is none.
    private sweepOf(shown: Shown): PlacedSweep | null {
        if (this.pane.state.layers.sweepDeg === null) return null;
        const { loaded } = shown;
        const moment = sweepMoment(this.pane.state.layers, shown.moment);
        const key = this.sweepKey(shown);
        const last = this.lastSweep?.of === loaded && this.lastSweep.moment === moment ? this.lastSweep : null;
        const found = this.shared.store.sweeps.find(key) ?? (last?.key === key ? last.sweep : null);
        if (found) this.lastSweep = { of: loaded, moment, key, sweep: found };
        if (found || isAbsent(this.shared.store.sweeps.errorOf(key)) || !this.shared.store.sweeps.isNeeded(key)) {
            // Tell the listener of a sweep that came or failed earlier, because no other event does. Tell it later,
            // because the listener may be the caller.
            if (this.toldSweep !== key) queueMicrotask(() => this.tellLayerCame());
            this.toldSweep = key;
            return found;
        }
        if (this.askedSweep !== key) {
            this.askedSweep = key;
            void this.takeSweep(shown, false).then(() => {
                this.askedSweep = '';
                const error = this.shared.store.sweeps.errorOf(key);
                if (error !== undefined && !isAbsent(error)) {
                    this.pane.fail(error);
                    this.askLater();
                }
                this.tellLayerCame();
                this.came();
            });
        }
        return last?.sweep ?? null;
    }
}

// Returns the name of a cut for the list and for told().
export function cutText(row: SweepRow, rows: SweepRow[]): string {
    const kind = kindOf(row, rows);
    return texts.layers.cut(
        row.elevation_deg.toFixed(1),
        row.start?.slice(11, 19) ?? '',
        kind === '' ? '' : texts.layers.kinds[kind],
    );
}
