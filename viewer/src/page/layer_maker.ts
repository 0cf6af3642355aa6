// Makes of the view's layers what the renderer draws: cuts of the grid that is shown, the grid of another
// moment, the sweep of its volume. What was made is kept as long as it is the same.

import { ViewGeometry } from '../camera/geometry';
import { airOf } from '../fields/air';
import { fallsOf } from '../fields/falls';
import { maximumField, planeField } from '../fields/flat_field';
import { Section, cutSection } from '../fields/section';
import { mixingOf } from '../fields/status_rule';
import { nearestSite, nearestSweep } from '../fields/sweep_choice';
import { coneOf, radialsByAzimuth } from '../fields/sweep_cone';
import { DrawnLayers, DrawnSurface, DrawnSweep } from '../renderer/layers';
import { LoadedGrid } from '../renderer/renderer';
import { Cells, extentOf, placingOf } from '../scene/grid_box';
import { Layers, isBelow, usualLayers } from '../scene/layers';
import { Place, Plane, planeOf } from '../scene/projection';
import { ColorTable } from '../tables/color_table';
import { heightText, valueText } from '../tables/units';
import { Looks, looksOf } from '../tables/looks';
import { SweepRow, gates, sweeps, volumeBefore } from '../wire/api';
import { PackedGrid } from '../wire/packed_grid';
import { readPackedSweep } from '../wire/packed_sweep';
import { App, Shown } from './app';
import { texts } from './texts';
import { Windows } from './windows';

const sectionColumns = 480;
const sectionRows = 192;

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
    private rows: Asked<{ time: string; rows: SweepRow[] }>;
    private sweep: Asked<DrawnSweep>;
    rowsCame: () => void = () => undefined; // the sweeps of the volume are known now

    constructor(
        private app: App,
        private windows: Windows,
        came: () => void,
    ) {
        const failed = (error: unknown) => app.fail(error);
        this.other = new Asked(came, failed);
        this.sweep = new Asked(came, failed);
        this.rows = new Asked(() => {
            this.rowsCame();
            came();
        }, failed);
    }

    // Something that is wanted has not come yet.
    get isWaiting(): boolean {
        return this.other.isWaiting || this.rows.isWaiting || this.sweep.isWaiting || this.windows.isWaiting;
    }

    // Null if nothing is to be drawn but the volume as it always was. While the view moves, no other part of a
    // grid is asked for.
    make(geometry: ViewGeometry, isMoving: boolean): DrawnLayers | null {
        this.isLeftOut = false;
        const { shown, shownTable: table, state } = this.app;
        const { layers } = state;
        const isUsual = (Object.keys(usualLayers) as (keyof Layers)[]).every(name => name === 'hasVolume' || layers[name] === usualLayers[name]);
        if (!shown || !table || isUsual) return this.nothing();
        const { loaded } = shown;
        const isFlat = layers.planeM !== null || layers.hasMaximum || layers.hasHaze || layers.hasFolded;
        const seen = this.needed('layers', isFlat, () => this.windows.seen(loaded, 'layers', geometry, isMoving));
        const lit = this.needed('light', layers.isLit, () => this.windows.seen(loaded, 'light', geometry, isMoving));
        const crossed = this.needed('section', layers.section !== null, () => this.windows.along(loaded, layers.section!));
        return {
            plane: seen && this.planeOf(seen, shown.moment, layers.planeM),
            section: crossed && this.sectionOf(crossed, shown.moment, layers.section!),
            surface: this.surfaceOf(shown, layers),
            maximum: seen && layers.hasMaximum ? this.maximumOf(seen) : null,
            sweep: layers.sweepDeg === null ? null : this.sweepOf(shown, layers.sweepDeg),
            crop: layers.crop,
            falls: lit && this.fallsOf(lit, shown, table),
            air: seen && (layers.hasHaze || layers.hasFolded) ? this.airOf(seen, shown) : null,
            hasHaze: layers.hasHaze,
            hasFolded: layers.hasFolded,
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
        const of = this.other.take(key, () => this.app.loader.load(shown.domain, moment, shown.time, this.app.isBetween(shown.time)));
        if (!of) return null;
        if (!hasSameCells(of.grid, shown.loaded.grid)) {
            this.app.say(texts.layers.otherCells(moment));
            return null;
        }
        return { ...drawn, of };
    }

    // The sweeps of the volume that is shown; null until they are known.
    sweepRows(): SweepRow[] | null {
        const { shown } = this.app;
        return shown && (this.rowsOf(shown)?.rows ?? null);
    }
    // What is drawn beside the volume, in words.
    told(): string[] {
        const { shown, state } = this.app;
        const { layers, units } = state;
        if (!shown) return [];
        const said: string[] = [];
        if (layers.planeM !== null) said.push(texts.layers.planeTold(heightText(layers.planeM, units)));
        if (layers.surface) {
            const moment = layers.surface.moment || shown.moment;
            const unit = this.app.domain?.moments.find(one => one.moment === moment)?.units ?? '';
            const value = valueText(layers.surface.value, unit, units);
            said.push(isBelow(moment, layers.surface.value) ? texts.layers.surfaceBelow(moment, value) : texts.layers.surfaceFrom(moment, value));
        }
        if (layers.hasMaximum) said.push(texts.layers.maximumTold);
        const row = layers.sweepDeg === null ? null : nearestSweep(this.rowsOf(shown)?.rows ?? [], shown.moment, layers.sweepDeg);
        if (row) said.push(texts.layers.sweepAt(this.stationOf(shown), row.elevation_deg.toFixed(1), row.start?.slice(11, 19) ?? ''));
        return said;
    }
    // Of several sites the one that is nearest to what is looked at.
    private stationOf({ loaded: { grid } }: Shown): string {
        const [x, y] = this.app.state.camera.lookAtM ?? [0, 0];
        return nearestSite(grid.sites, planeOf(grid), [x, y])?.icao ?? '';
    }
    private rowsOf(shown: Shown): { time: string; rows: SweepRow[] } | null {
        const { time } = shown;
        const station = this.stationOf(shown);
        return this.rows.take(`${station} ${time}`, async () => {
            const volume = await volumeBefore(station, time);
            if (volume === null) throw new Error(texts.layers.noVolume(station));
            return { time: volume, rows: await sweeps(station, volume) };
        });
    }

    private sweepOf(shown: Shown, elevationDeg: number): DrawnSweep | null {
        const known = this.rowsOf(shown);
        const row = known && nearestSweep(known.rows, shown.moment, elevationDeg);
        if (!row) return null;
        const station = this.stationOf(shown);
        return this.sweep.take(`${station} ${known.time} ${row.sweep} ${shown.moment} ${shown.key}`, async () => {
            const read = readPackedSweep(new Uint8Array(await gates(station, known.time, row.sweep, shown.moment)));
            return { gates: read, radials: radialsByAzimuth(read), cone: coneOf(read, planeOf(shown.loaded.grid)) };
        });
    }
}
