// Finds the cells that layers and readings are made of. A grid that is there as a whole has them all; for one
// in parts, asks the server for a window, as fine as it is worth and as there is room for.

import {
    BrickWindow,
    WindowLimits,
    boundsAbout,
    holds,
    windowAbout,
    windowQuery,
    windowSeen,
} from '../atlas/window_choice';
import { Decoder } from '../atlas/decoder';
import { ViewGeometry } from '../camera/geometry';
import { GridInParts, LoadedGrid } from '../atlas/loaded_grid';
import { Cells } from '../scene/grid_box';
import { Place, Plane, cellSizeM, destination, geodesic, middleOn, planeOf } from '../earth/projection';
import { isAbsent, packed } from '../wire/api';
import { PackedGrid } from '../wire/packed_grid';

// Purpose of a window. There is one window at a time for each, and one of the grid that is shown next.
export type Purpose = 'layers' | 'light' | 'section' | 'ray';

// Shares of the page's memory.
const bytesOfWindow = 0.06;
const fieldOfLayers = 0.05;
const bytesOfFields = 10; // of a column, in two of them
const fallsOfLight = 0.05;
const columnsOfSection = 480;
const pointsOfLine = 32;
const againAfterMs = 3000; // what failed

interface Held {
    of: LoadedGrid; // whose window it is
    asked: BrickWindow | null;
    has: BrickWindow | null; // the last one that came
    cells: Cells | null; // of it
    abort: AbortController | null; // of the request on its way, or of one that failed: the picture is not complete
    done: Promise<void>; // it came, or is not wanted any more; it fails if the grid is gone
}

export class Windows {
    private held = new Map<Purpose, Held>();
    private ahead = new Map<Purpose, Held>(); // of the grid that is shown next
    private taken = this.held; // where what is asked for goes
    private wholes = new WeakMap<PackedGrid, Cells>();

    constructor(
        private decoder: Decoder,
        private budgetBytes: number,
        private came: () => void,
        private fail: (error: unknown) => void,
    ) {}

    // Something that layers are made of has not come yet.
    get isWaiting(): boolean {
        return [...this.held].some(([purpose, { abort }]) => purpose !== 'ray' && abort !== null);
    }
    get bytes(): number {
        return [...this.held.values(), ...this.ahead.values()].reduce(
            (sum, { cells }) => sum + (cells ? cells.grid.codes.byteLength + cells.grid.states.byteLength : 0),
            0,
        );
    }
    // Returns how often the coarsest window of the layers was halved; 0 if the grid is not in parts.
    coarsest(loaded: LoadedGrid): number {
        return Math.max(
            0,
            ...[...this.held].map(([purpose, { of, cells }]) =>
                purpose === 'ray' || of !== loaded ? 0 : (cells?.grid.halvings ?? 0),
            ),
        );
    }
    // Returns how often the cells for a purpose were halved.
    halvings(loaded: LoadedGrid, purpose: Purpose): number {
        return (loaded.stream ? this.cellsOf(loaded, purpose)?.grid : loaded.grid)?.halvings ?? 0;
    }

    // Returns what the view shows, or while it moves, what was there before; null until something has come.
    seen(loaded: LoadedGrid, purpose: 'layers' | 'light', geometry: ViewGeometry, isMoving: boolean): Cells | null {
        const { grid, stream } = loaded;
        if (!stream) return this.whole(grid);
        if (isMoving) return this.cellsOf(loaded, purpose);
        const placed = { geometry, edge: grid.brickEdge, cellSizeM: cellSizeM(grid) };
        const window = windowSeen(placed, stream.pyramid, grid, this.limitsFor(purpose, grid));
        return window && this.take(loaded, stream, purpose, window);
    }

    // Returns the cells that a line between two places crosses, with those beside it; null until they have come.
    along(loaded: LoadedGrid, [from, to]: readonly [Place, Place]): Cells | null {
        const { grid, stream } = loaded;
        if (!stream) return this.whole(grid);
        const way = geodesic(from, to);
        const plane = planeOf(grid);
        const points = Array.from({ length: pointsOfLine + 1 }, (_, i) =>
            plane.toPlane(destination(from, way.azimuth, (i / pointsOfLine) * way.distanceM)),
        );
        // No finer than a plot of the section shows it.
        const finest = Math.max(
            0,
            Math.floor(Math.log2(way.distanceM / columnsOfSection / Math.max(...cellSizeM(grid)))),
        );
        return this.about(
            loaded,
            stream,
            'section',
            points.filter((point): point is Plane => point !== null),
            finest,
        );
    }

    // Asks ahead for what `ask` needs of the grid that is shown next. Null if all of it is there.
    next(loaded: LoadedGrid, ask: () => void): Promise<void> | null {
        if (!loaded.stream) return null;
        this.taken = this.ahead;
        ask();
        this.taken = this.held;
        const waits = [...this.ahead.values()].filter((one) => one.of === loaded && one.abort !== null);
        return waits.length > 0 ? Promise.all(waits.map((one) => one.done)).then(() => undefined) : null;
    }

    // Returns the cells between points, the grid's own if there is room; null until they have come.
    ray(loaded: LoadedGrid, points: readonly Plane[]): Cells | null {
        const { grid, stream } = loaded;
        return stream ? this.about(loaded, stream, 'ray', points, 0) : this.whole(grid);
    }

    private about(
        loaded: LoadedGrid,
        stream: GridInParts,
        purpose: Purpose,
        points: readonly Plane[],
        finest: number,
    ): Cells | null {
        const { grid } = loaded;
        const bounds = boundsAbout(points, grid);
        if (!bounds) return null;
        const level = Math.min(finest, stream.pyramid.levels.length - 1);
        const window = windowAbout(bounds, level, 1, stream.pyramid, grid, this.limitsFor(purpose, grid));
        const cells = this.take(loaded, stream, purpose, window);
        const has = this.taken.get(purpose)?.has;
        return has && holds(has, window) ? cells : null;
    }

    private whole(grid: PackedGrid): Cells {
        let cells = this.wholes.get(grid);
        if (!cells) this.wholes.set(grid, (cells = { grid, middle: [0, 0] }));
        return cells;
    }

    private limitsFor(purpose: Purpose, { nz }: PackedGrid): WindowLimits {
        const bytes = bytesOfWindow * this.budgetBytes;
        if (purpose === 'light') return { bytes, columns: (fallsOfLight * this.budgetBytes) / nz };
        return { bytes, columns: (fieldOfLayers * this.budgetBytes) / bytesOfFields };
    }

    private cellsOf(loaded: LoadedGrid, purpose: Purpose): Cells | null {
        const held = this.held.get(purpose);
        return held?.of === loaded ? held.cells : null;
    }

    // Returns the window, or until it comes the one before it.
    private take(loaded: LoadedGrid, stream: GridInParts, purpose: Purpose, window: BrickWindow): Cells | null {
        let held = this.taken.get(purpose);
        if (held?.of !== loaded) {
            held?.abort?.abort();
            const other = this.taken === this.held ? this.ahead : this.held;
            const known = other.get(purpose);
            if (known?.of === loaded && other === this.ahead) other.delete(purpose);
            held =
                known?.of === loaded
                    ? known
                    : { of: loaded, asked: null, has: null, cells: null, abort: null, done: Promise.resolve() };
            this.taken.set(purpose, held);
        }
        if (!held.asked || !holds(held.asked, window)) {
            held.done = this.fetch(held, loaded, stream, window);
            held.done.catch(() => undefined);
        }
        return held.cells;
    }

    // A window that failed is asked for again, because a picture without its layer looks like clear air.
    private async fetch(held: Held, loaded: LoadedGrid, stream: GridInParts, window: BrickWindow): Promise<void> {
        const { grid } = loaded;
        const { domain, moment, time } = stream;
        held.abort?.abort();
        const abort = (held.abort = new AbortController());
        const isOver = () => abort.signal.aborted;
        held.asked = window;
        try {
            const bytes = await packed(
                domain,
                moment,
                time,
                { ...windowQuery(window), codes: 'values', id: grid.id },
                abort.signal,
            );
            const { grid: cells } = await this.decoder.ask({ kind: 'cells', bytes });
            if (isOver()) return;
            held.cells = { grid: cells, middle: middleOn(grid, cells) };
            held.has = window;
        } catch (error) {
            if (isOver()) return;
            this.fail(error);
            if (isAbsent(error)) throw error;
            await new Promise((done) => setTimeout(done, againAfterMs));
            return isOver() ? undefined : this.fetch(held, loaded, stream, window);
        }
        held.abort = null;
        this.came();
    }

    // Gives back a window that no layer and no reading needs.
    release(purpose: Purpose): void {
        this.held.get(purpose)?.abort?.abort();
        this.held.delete(purpose);
    }
}
