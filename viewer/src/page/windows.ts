// Finds the cells for layers and readings. A whole grid has all cells. For a grid in parts, asks the server for a
// window: a rectangle of its columns, with cells as fine as the view shows and memory allows.

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

// Purpose of a window. Each purpose has at most one window of the shown grid, and one of the grid that is shown next.
export type Purpose = 'layers' | 'light' | 'section' | 'ray';

const bytesOfWindow = 0.06; // share of the page's memory for the cells of a window
const fieldOfLayers = 0.05; // share for the flat fields (such as planes) that are cut from a window
const bytesOfFields = 10; // bytes that a column of cells takes in two flat fields
const fallsOfLight = 0.05; // share for the falls (how steeply values fall; fields/falls.ts) of a window for light
const columnsOfSection = 480;
const pointsOfLine = 32;
const againAfterMs = 3000; // after a failure

interface Held {
    of: LoadedGrid; // grid of the window
    asked: BrickWindow | null; // window that was last asked for
    has: BrickWindow | null; // last window that came
    cells: Cells | null; // cells of `has`
    abort: AbortController | null; // aborts the request for `asked`; null if nothing is being fetched
    done: Promise<void>; // resolves when `asked` comes or is replaced; rejects if the grid is gone
}

export class Windows {
    private held = new Map<Purpose, Held>();
    private ahead = new Map<Purpose, Held>(); // windows of the grid that is shown next
    private taken = this.held; // the map that take() uses: `ahead` during next(), otherwise `held`
    private wholes = new WeakMap<PackedGrid, Cells>();

    constructor(
        private decoder: Decoder,
        private budgetBytes: () => number,
        private came: () => void,
        private fail: (error: unknown) => void,
    ) {}

    // Returns true if a window of the shown grid has not come. Windows for readings along a ray do not count.
    get isWaiting(): boolean {
        return [...this.held].some(([purpose, { abort }]) => purpose !== 'ray' && abort !== null);
    }
    get bytes(): number {
        return [...this.held.values(), ...this.ahead.values()].reduce(
            (sum, { cells }) => sum + (cells ? cells.grid.codes.byteLength + cells.grid.states.byteLength : 0),
            0,
        );
    }
    // Returns the number of halvings of the coarsest window. Windows along a ray do not count. Returns 0 for a whole
    // grid, and if no window has come.
    coarsest(loaded: LoadedGrid): number {
        return Math.max(
            0,
            ...[...this.held].map(([purpose, { of, cells }]) =>
                purpose === 'ray' || of !== loaded ? 0 : (cells?.grid.halvings ?? 0),
            ),
        );
    }
    // Returns the number of halvings of the cells for a purpose; 0 if they have not come.
    halvings(loaded: LoadedGrid, purpose: Purpose): number {
        return (loaded.stream ? this.cellsOf(loaded, purpose)?.grid : loaded.grid)?.halvings ?? 0;
    }

    // Returns all cells of a whole grid. For a grid in parts, returns the cells that the view shows, or null if the
    // view shows no part of the grid. While the view moves, and until the new cells have come, returns the last cells
    // that came for this grid and purpose, or null if there are none.
    seen(loaded: LoadedGrid, purpose: 'layers' | 'light', geometry: ViewGeometry, isMoving: boolean): Cells | null {
        const { grid, stream } = loaded;
        if (!stream) return this.whole(grid);
        if (isMoving) return this.cellsOf(loaded, purpose);
        const placed = { geometry, edge: grid.brickEdge, cellSizeM: cellSizeM(grid) };
        const window = windowSeen(placed, stream.pyramid, grid, this.limitsFor(purpose, grid));
        return window && this.take(loaded, stream, purpose, window);
    }

    // Returns all cells of a whole grid. For a grid in parts, returns the cells along the geodesic between two places.
    // Returns null until these cells have come, or if all of the geodesic is beyond one side of the grid.
    along(loaded: LoadedGrid, [from, to]: readonly [Place, Place]): Cells | null {
        const { grid, stream } = loaded;
        if (!stream) return this.whole(grid);
        const way = geodesic(from, to);
        const plane = planeOf(grid);
        const points = Array.from({ length: pointsOfLine + 1 }, (_, i) =>
            plane.toPlane(destination(from, way.azimuth, (i / pointsOfLine) * way.distanceM)),
        );
        // Find the coarsest level whose cells are not wider than the columns of a plot of the section. If even the
        // cells of level 0 are wider, take level 0.
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

    // Calls `ask`, and keeps the windows that `ask` requests as windows of the next grid. Returns a promise that
    // resolves when all of these windows have come. Returns null if none is missing, and for a whole grid, for which
    // `ask` is not called.
    next(loaded: LoadedGrid, ask: () => void): Promise<void> | null {
        if (!loaded.stream) return null;
        this.taken = this.ahead;
        ask();
        this.taken = this.held;
        const waits = [...this.ahead.values()].filter((one) => one.of === loaded && one.abort !== null);
        return waits.length > 0 ? Promise.all(waits.map((one) => one.done)).then(() => undefined) : null;
    }

    // Returns all cells of a whole grid. For a grid in parts, returns the cells about the points: of level 0 if they
    // fit into memory, otherwise coarser cells. Returns null until these cells have come, or if all points are beyond
    // one side of the grid.
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
        const bytes = bytesOfWindow * this.budgetBytes();
        if (purpose === 'light') return { bytes, columns: (fallsOfLight * this.budgetBytes()) / nz };
        return { bytes, columns: (fieldOfLayers * this.budgetBytes()) / bytesOfFields };
    }

    private cellsOf(loaded: LoadedGrid, purpose: Purpose): Cells | null {
        const held = this.held.get(purpose);
        return held?.of === loaded ? held.cells : null;
    }

    // Asks for a window, unless the last requested window covers it. Returns the last cells that came for this purpose.
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

    // Fetches a window. After a failure, tries again, because a picture without its layer would look like clear air. If
    // the grid is gone, throws instead.
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

    // Drops the shown grid's window for a purpose, and aborts its request.
    release(purpose: Purpose): void {
        this.held.get(purpose)?.abort?.abort();
        this.held.delete(purpose);
    }
}
