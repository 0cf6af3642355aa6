// Fetches sweeps and lists of sweeps, and keeps them for all panes.

import { LoadedGrid } from '../atlas/loaded_grid';
import { planeOf } from '../earth/projection';
import { CutNumber, cutOf } from '../fields/sweep_choice';
import { coneOf, radialsByAzimuth } from '../fields/sweep_cone';
import { DrawnSweep } from '../renderer/layer_passes';
import { ApiError, SweepRow, gates, rawBefore, sweeps } from '../wire/api';
import { readPackedSweep } from '../wire/packed_sweep';
import type { Shown } from './app';
import { FetchedInTurn } from './fetched_in_turn';
import { texts } from './texts';

const oldestVolumeMs = 30 * 60 * 1000; // no radar takes so long for one volume

// A sweep to draw, its cut, and all cuts of its volume.
export interface PlacedSweep {
    rows: SweepRow[];
    row: SweepRow;
    moment: string;
    quality: number; // least probability of weather
    drawn: DrawnSweep;
}

// Names a sweep of a shown volume.
export interface WantedSweep {
    station: string;
    moment: string;
    elevationDeg: number;
    number: CutNumber;
    quality: number;
}

const bytesOfSweep = ({
    drawn: {
        gates: { codes },
        radials,
        cone,
    },
}: PlacedSweep): number => codes.byteLength + radials.byteLength + cone.corners.byteLength + cone.triangles.byteLength;

type Rows = Promise<{ time: string; rows: SweepRow[] }>;

export class SweepStore {
    readonly sweeps: FetchedInTurn<PlacedSweep>;
    private rows = new WeakMap<LoadedGrid, Map<string, Rows>>(); // by station
    private numbers = new WeakMap<LoadedGrid, number>();
    private mostNumber = 0;

    constructor(mostBytes: number) {
        this.sweeps = new FetchedInTurn(mostBytes, bytesOfSweep);
    }

    rowsOf({ loaded, time }: Shown, station: string): Rows {
        const known = this.rows.get(loaded) ?? new Map<string, Rows>();
        this.rows.set(loaded, known);
        let asked = known.get(station);
        if (!asked) {
            asked = (async () => {
                const volume = (await rawBefore(station, time))?.time ?? null;
                // Refuse an old volume, whose sweeps do not show the weather at this time.
                if (volume === null || Date.parse(time) - Date.parse(volume) > oldestVolumeMs)
                    throw new ApiError(404, texts.layers.noVolume(station));
                return { time: volume, rows: await sweeps(station, volume) };
            })();
            known.set(station, asked);
            asked.catch(() => known.delete(station));
        }
        return asked;
    }

    // Returns a number for a loaded grid, for keys. The time of the grid is not enough, because a grid that was made
    // again may have another volume, and so other sweeps.
    private numberOf(loaded: LoadedGrid): number {
        if (!this.numbers.has(loaded)) this.numbers.set(loaded, ++this.mostNumber);
        return this.numbers.get(loaded)!;
    }
    keyOf({ loaded }: Shown, { station, moment, elevationDeg, number, quality }: WantedSweep): string {
        return [this.numberOf(loaded), moment, station, elevationDeg, number, quality].join(' ');
    }

    // Fetches a sweep if it is needed, and resolves when it has come or failed.
    take(shown: Shown, wanted: WantedSweep, isAhead: boolean): Promise<void> {
        const { station, moment, elevationDeg, number, quality } = wanted;
        const fetch = async (): Promise<PlacedSweep> => {
            const { time, rows } = await this.rowsOf(shown, station);
            const row = cutOf(rows, moment, elevationDeg, number);
            if (!row) throw new ApiError(404, texts.layers.noSweep(station));
            // Another way to name the cut may have fetched the same sweep.
            const known = this.sweeps.search(
                (one) => one.row === row && one.moment === moment && one.quality === quality,
            );
            if (known) return known;
            const bytes = await gates(station, time, row.sweep, moment, quality);
            const read = readPackedSweep(new Uint8Array(bytes));
            const drawn = {
                station,
                gates: read,
                radials: radialsByAzimuth(read),
                cone: coneOf(read, planeOf(shown.loaded.grid)),
            };
            return { rows, row, moment, quality, drawn };
        };
        return this.sweeps.take(this.keyOf(shown, wanted), fetch, isAhead);
    }
}
