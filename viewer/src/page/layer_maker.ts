// Makes of the view's layers what the renderer draws: cuts of the grid that is shown, the grid of another
// moment, the sweep of its volume. What was made is kept as long as it is the same.

import { ViewGeometry } from '../camera/geometry';
import { airOf } from '../fields/air';
import { fallsOf } from '../fields/falls';
import { maximumField, planeField } from '../fields/flat_field';
import { Section, cutSection } from '../fields/section';
import { mixingOf } from '../fields/status_rule';
import { cutOf, kindOf, nearestSite } from '../fields/sweep_choice';
import { coneOf, radialsByAzimuth } from '../fields/sweep_cone';
import { DrawnLayers, DrawnSurface, DrawnSweep } from '../renderer/layers';
import { LoadedGrid } from '../renderer/renderer';
import { Cells, extentOf, placingOf } from '../scene/grid_box';
import { Layers, isBelow, usualLayers, veilsFolded } from '../scene/layers';
import { Place, Plane, planeOf } from '../scene/projection';
import { ColorTable } from '../tables/color_table';
import { heightText, valueText } from '../tables/units';
import { Looks, looksOf } from '../tables/looks';
import { SweepRow, gates, sweeps, volumeBefore } from '../wire/api';
import { PackedGrid, valueOf } from '../wire/packed_grid';
import { readPackedSweep } from '../wire/packed_sweep';
import { App, Shown } from './app';
import { FetchedInTurn } from './fetched_in_turn';
import { Loader } from './loader';
import { texts } from './texts';
import { Windows } from './windows';

const sectionColumns = 480;
const sectionRows = 192;
const oldestVolumeMs = 30 * 60 * 1000; // no radar takes so long for one volume
const sweepsOfBudget = 0.2; // of the bytes that the page may hold

// A sweep as it is drawn, and the sweeps of its volume.
interface PlacedSweep {
    rows: SweepRow[];
    row: SweepRow;
    drawn: DrawnSweep;
}

const bytesOfSweep = ({ drawn: { gates: { codes }, radials, cone } }: PlacedSweep): number =>
    codes.byteLength + radials.byteLength + cone.corners.byteLength + cone.triangles.byteLength;

// The last value of each name, with what it was made of.
class Kept {
    private held = new Map<string, { of: readonly unknown[]; value: unknown }>();

    take<T>(name: string, of: readonly unknown[], make: () => T): T {
        const known = this.held.get(name);
        if (known && known.of.length === of.length && known.of.every((part, i) => part === of[i])) return known.value as T;
        const value = make();
        this.held.set(name, { of, value });
        return value;
    }
}

// Something from the server that is asked for once for a key; null until it has come.
class Asked<T> {
    private key = '';
    private value: T | null = null;
    isWaiting = false;

    constructor(
        private came: () => void,
        private failed: (error: unknown) => void,
    ) {}

    take(key: string, ask: () => Promise<T>): T | null {
        if (this.key === key) return this.value;
        this.key = key;
        this.value = null;
        this.isWaiting = true;
        ask().then(
            value => this.key === key && this.put(value),
            error => {
                if (this.key !== key) return;
                this.isWaiting = false;
                this.failed(error);
            },
        );
        return null;
    }
    private put(value: T): void {
        this.isWaiting = false;
        this.value = value;
        this.came();
    }
}

const hasSameCells = (a: PackedGrid, b: PackedGrid): boolean =>
    a.nx === b.nx && a.ny === b.ny && a.nz === b.nz && a.spacing === b.spacing && a.levelsM.every((level, z) => level === b.levelsM[z]);

// The section, on the plane of the grid that is shown.
function movedBy(section: Section, [x, y]: Plane): Section {
    return { ...section, ends: section.ends.map(([east, north]): Plane => [east + x, north + y]) };
}

export class LayerMaker {
    isLeftOut = false; // what is asked for cannot be made of this grid
    private kept = new Kept();
    private other: Asked<LoadedGrid>;
    private sweeps: FetchedInTurn<PlacedSweep>;
    private rows = new WeakMap<LoadedGrid, Map<string, Promise<{ time: string; rows: SweepRow[] }>>>(); // by station
    private numbers = new WeakMap<LoadedGrid, number>();
    private mostNumber = 0;
    private lastSweep: { of: LoadedGrid; moment: string; sweep: PlacedSweep } | null = null;
    private askedSweep = ''; // the one whose coming is waited for
    private missingOthers = new Set<string>(); // grids of another moment that could not be had
    sweepCame: () => void = () => undefined; // or failed

    constructor(
        private app: App,
        private windows: Windows,
        private came: () => void,
    ) {
        const failed = (error: unknown) => app.fail(error);
        this.other = new Asked(came, failed);
        this.sweeps = new FetchedInTurn(sweepsOfBudget * app.loader.budget.bytes, bytesOfSweep);
    }

    // Something that is wanted has not come yet.
    get isWaiting(): boolean {
        return this.other.isWaiting || this.isWaitingForSweep || this.windows.isWaiting;
    }
    private get isWaitingForSweep(): boolean {
        const { shown, state } = this.app;
        return shown !== null && state.layers.sweepDeg !== null && !this.sweeps.isSettled(this.sweepKey(shown));
    }

    // What else must come before this is shown: a sweep, or the grid of another moment; null if all is there.
    // `geometry` is that of the next picture.
    alongside(next: Shown, isAhead: boolean, geometry: ViewGeometry): Promise<void> | null {
        const { surface, sweepDeg } = this.app.state.layers;
        const waits: Promise<unknown>[] = [];
        if (sweepDeg !== null && this.sweeps.isNeeded(this.sweepKey(next))) waits.push(this.takeSweep(next, isAhead));
        const other = surface?.moment || next.moment;
        const key = Loader.key(next.domain, other, next.time);
        if (other !== next.moment && next.loaded.stream === null && !this.app.loader.has(key) && !this.missingOthers.has(key))
            waits.push(this.app.loader.load(next.domain, other, next.time, this.app.isBetween(next.time)).catch(() => this.missingOthers.add(key)));
        // There is room for the windows of one grid ahead.
        const windows = isAhead ? null : this.windows.next(next.loaded, () => this.cellsOf(next.loaded, geometry, false));
        if (windows) waits.push(windows);
        return waits.length > 0 ? Promise.all(waits).then(() => undefined) : null;
    }
    // The cells of which layers are made; what no layer needs is given back.
    private cellsOf(loaded: LoadedGrid, geometry: ViewGeometry, isMoving: boolean): { seen: Cells | null; lit: Cells | null; crossed: Cells | null } {
        const { layers } = this.app.state;
        const isFlat = layers.planeM !== null || layers.hasMaximum || layers.hasHaze || veilsFolded(layers, this.app.shown?.moment ?? '');
        return {
            seen: this.needed('layers', isFlat, () => this.windows.seen(loaded, 'layers', geometry, isMoving)),
            lit: this.needed('light', layers.isLit, () => this.windows.seen(loaded, 'light', geometry, isMoving)),
            crossed: this.needed('section', layers.section !== null, () => this.windows.along(loaded, layers.section!)),
        };
    }

    // Null if nothing is to be drawn but the volume as it always was. While the view moves, no other part of a
    // grid is asked for.
    make(geometry: ViewGeometry, isMoving: boolean): DrawnLayers | null {
        this.isLeftOut = false;
        const { shown, shownTable: table, state } = this.app;
        const { layers } = state;
        const isUsual = (Object.keys(usualLayers) as (keyof Layers)[]).every(name => name === 'hasVolume' || layers[name] === usualLayers[name]);
        if (!shown || !table) return this.nothing();
        const hasFolded = veilsFolded(layers, shown.moment);
        if (isUsual && !hasFolded) return this.nothing();
        const { loaded } = shown;
        const { seen, lit, crossed } = this.cellsOf(loaded, geometry, isMoving);
        return {
            plane: seen && this.planeOf(seen, shown.moment, layers.planeM),
            section: crossed && this.sectionOf(crossed, shown.moment, layers.section!),
            surface: this.surfaceOf(shown, layers),
            maximum: seen && layers.hasMaximum ? this.maximumOf(seen) : null,
            sweep: this.sweepOf(shown)?.drawn ?? null,
            crop: layers.crop,
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
        return this.kept.take('maximum', [cells.grid], () => ({ field: maximumField(cells.grid), extent: extentOf(cells) }));
    }
    private sectionOf({ grid, middle }: Cells, moment: string, ends: readonly [Place, Place]): Section {
        return this.kept.take('section', [grid, ends[0], ends[1]], () => movedBy(cutSection(grid, moment, ends[0], ends[1], sectionColumns, sectionRows), middle));
    }
    private airOf(cells: Cells, shown: Shown): DrawnLayers['air'] {
        return this.kept.take('air', [cells.grid], () => ({ ...airOf(cells.grid), placing: placingOf(cells, shown.loaded.grid) }));
    }
    private fallsOf(cells: Cells, shown: Shown, table: ColorTable): DrawnLayers['falls'] {
        const make = () => ({ ...fallsOf(cells.grid, shown.moment, table.stops[0]!.from), placing: placingOf(cells, shown.loaded.grid) });
        return this.kept.take('falls', [cells.grid, table], make);
    }
    private looksOf(table: ColorTable, least: number | null): Looks {
        return this.kept.take('looks', [table, least], () => looksOf(table, least ?? -1e9));
    }

    private surfaceOf(shown: Shown, { surface }: Layers): DrawnSurface | null {
        if (!surface) return null;
        const moment = surface.moment || shown.moment;
        const drawn = { value: surface.value, isBelow: isBelow(moment, surface.value) };
        if (moment === shown.moment) return { ...drawn, of: null };
        // It would need the bricks of two grids at once.
        this.isLeftOut = shown.loaded.stream !== null;
        if (this.isLeftOut) return null;
        const key = `${shown.domain} ${moment} ${shown.time}`;
        const { loader } = this.app;
        const of = loader.find(Loader.key(shown.domain, moment, shown.time)) ?? this.other.take(key, () => loader.load(shown.domain, moment, shown.time, this.app.isBetween(shown.time)));
        if (!of) return null;
        if (!hasSameCells(of.grid, shown.loaded.grid)) {
            this.app.say(texts.layers.otherCells(moment));
            return null;
        }
        return { ...drawn, of };
    }

    // The sweeps of the volume of which one is drawn, and which; null until they are known.
    sweepRows(): SweepRow[] | null {
        const { shown } = this.app;
        return shown && (this.sweepOf(shown)?.rows ?? null);
    }
    shownCut(): SweepRow | null {
        const { shown } = this.app;
        return shown && (this.sweepOf(shown)?.row ?? null);
    }
    // A volume of which nothing is visible says so.
    private emptyTold({ moment, loaded: { grid, atlas } }: Shown): string[] {
        const { state, shownTable: table } = this.app;
        const unit = this.app.domain?.moments.find(one => one.moment === moment)?.units ?? '';
        if (!table) return [];
        const least = Math.max(table.stops[0]!.from, table.extinction[0]!.value, state.least ?? -Infinity);
        const hasVisible = atlas.brickCount > 0 && valueOf(grid, atlas.greatest) >= least;
        return hasVisible ? [] : [texts.layers.noEchoFrom(valueText(least, unit, state.units))];
    }
    // What is drawn beside the volume, in words.
    told(): string[] {
        const { shown, state } = this.app;
        const { layers, units } = state;
        if (!shown) return [];
        const said = layers.hasVolume ? this.emptyTold(shown) : [];
        if (layers.planeM !== null) said.push(texts.layers.planeTold(heightText(layers.planeM, units)));
        if (layers.surface) {
            const moment = layers.surface.moment || shown.moment;
            const unit = this.app.domain?.moments.find(one => one.moment === moment)?.units ?? '';
            const value = valueText(layers.surface.value, unit, units);
            said.push(isBelow(moment, layers.surface.value) ? texts.layers.surfaceBelow(moment, value) : texts.layers.surfaceFrom(moment, value));
        }
        if (layers.hasMaximum) said.push(texts.layers.maximumTold);
        if (layers.sweepDeg !== null) said.push(this.sweepTold(shown));
        return said;
    }
    private sweepTold(shown: Shown): string {
        const station = this.stationOf(shown);
        const found = this.sweepOf(shown);
        if (found) return texts.layers.sweepAt(station, cutText(found.row, found.rows));
        return this.sweeps.isSettled(this.sweepKey(shown)) ? texts.layers.noSweep(station) : texts.layers.sweepComes(station);
    }
    // The station whose sweep is drawn.
    sweepStation(): string {
        const { shown } = this.app;
        return shown ? this.stationOf(shown) : '';
    }
    // Of several sites the one that is nearest to what is looked at.
    private stationOf({ loaded: { grid } }: Shown): string {
        const [x, y] = this.app.state.camera.lookAtM ?? [0, 0];
        return nearestSite(grid.sites, planeOf(grid), [x, y])?.icao ?? '';
    }
    private rowsOf({ loaded, time }: Shown, station: string): Promise<{ time: string; rows: SweepRow[] }> {
        const known = this.rows.get(loaded) ?? new Map<string, Promise<{ time: string; rows: SweepRow[] }>>();
        this.rows.set(loaded, known);
        let asked = known.get(station);
        if (!asked) {
            asked = (async () => {
                const volume = await volumeBefore(station, time);
                // The sweep of an older one is not what was there at this time.
                if (volume === null || Date.parse(time) - Date.parse(volume) > oldestVolumeMs) throw new Error(texts.layers.noVolume(station));
                return { time: volume, rows: await sweeps(station, volume) };
            })();
            known.set(station, asked);
            asked.catch(() => known.delete(station));
        }
        return asked;
    }

    // A grid that was made again may have another volume's sweeps, so that the time is not enough.
    private sweepKey(shown: Shown): string {
        const { loaded, moment } = shown;
        if (!this.numbers.has(loaded)) this.numbers.set(loaded, ++this.mostNumber);
        const { sweepDeg, sweepNumber } = this.app.state.layers;
        return [this.numbers.get(loaded), moment, this.stationOf(shown), sweepDeg, sweepNumber].join(' ');
    }
    private takeSweep(shown: Shown, isAhead: boolean): Promise<void> {
        const { sweepDeg, sweepNumber } = this.app.state.layers;
        const { loaded, moment } = shown;
        const station = this.stationOf(shown);
        const fetch = async (): Promise<PlacedSweep> => {
            const { time, rows } = await this.rowsOf(shown, station);
            const row = cutOf(rows, moment, sweepDeg!, sweepNumber);
            if (!row) throw new Error(texts.layers.noSweep(station));
            const read = readPackedSweep(new Uint8Array(await gates(station, time, row.sweep, moment)));
            return { rows, row, drawn: { gates: read, radials: radialsByAzimuth(read), cone: coneOf(read, planeOf(loaded.grid)) } };
        };
        return this.sweeps.take(this.sweepKey(shown), fetch, isAhead);
    }

    // While another sweep of the same volume comes, the one before stays.
    private sweepOf(shown: Shown): PlacedSweep | null {
        if (this.app.state.layers.sweepDeg === null) return null;
        const { loaded, moment } = shown;
        const key = this.sweepKey(shown);
        const found = this.sweeps.find(key);
        if (found) this.lastSweep = { of: loaded, moment, sweep: found };
        if (found || this.sweeps.isSettled(key)) return found;
        if (this.askedSweep !== key) {
            this.askedSweep = key;
            void this.takeSweep(shown, false).then(() => {
                this.askedSweep = '';
                const error = this.sweeps.errorOf(key);
                if (error !== undefined) this.app.fail(error);
                this.sweepCame();
                this.came();
            });
        }
        return this.lastSweep?.of === loaded && this.lastSweep.moment === moment ? this.lastSweep.sweep : null;
    }
}

// A cut as the list and the title name it.
export function cutText(row: SweepRow, rows: SweepRow[]): string {
    const kind = kindOf(row, rows);
    return texts.layers.cut(row.elevation_deg.toFixed(1), row.start?.slice(11, 19) ?? '', kind === '' ? '' : texts.layers.kinds[kind]);
}
