// Fetches the bricks of a grid in parts that a view needs, from the middle of the picture outward. The picture always
// shows the finest bricks that have come, and elsewhere the first halved grid.

import { GridInParts, LoadedGrid } from '../atlas/loaded_grid';
import { cellSizeM } from '../earth/projection';
import { paintPages } from '../atlas/page_table';
import { SlotPool, columnKey } from '../atlas/slot_pool';
import { WantedColumn, wantedColumns } from '../atlas/view_choice';
import { Renderer } from '../renderer/renderer';
import { ViewGeometry } from '../camera/geometry';
import { isAbsent, packed } from '../wire/api';
import { BrickRange, rangesOf } from '../wire/ranges';
import { Decoder } from '../atlas/decoder';

const mostFlights = 5; // a browser has six connections to a server, and one is for events
const mostRequestBytes = 1024 * 1024; // most uncompressed bytes of a request
const mostPlannedBytes = 4 * mostRequestBytes; // requests are chosen from missing columns of about this many bytes
const mostSkippedBytes = 64 * 1024; // most bytes between two needed columns of a request
const retryMs = 1000;
const mostFailures = 5; // consecutive failures before an error is shown

// Describes which of the needed bricks have come.
export interface Detail {
    missing: number; // number of columns of bricks that have not come
    coarsest: number; // level of the coarsest bricks in the picture
    isGone: boolean; // the missing columns will not come, because the grid is gone
}

interface Flight {
    level: number;
    columns: Set<string>;
    abort: AbortController;
}

// Streams one grid in parts, while it is shown.
class Stream {
    private pool: SlotPool;
    private cells = new Map<string, number>(); // bytes of the columns whose codes the worker has, the oldest first
    private tables = new Map<number, 'coming' | 'there'>(); // tables of halved grids, by level
    private waitsUntil = 0;
    private flights: Flight[] = [];
    private making = new Set<string>();
    private wanted: WantedColumn[] = [];
    private wantedKeys = new Set<string>();
    private failures = 0;
    hasEnded = false;

    constructor(
        private loaded: LoadedGrid,
        private parts: GridInParts,
        private renderer: Renderer,
        private decoder: Decoder,
        private mostCells: number, // bytes of codes that the worker keeps
        private changed: () => void,
        private fail: (error: unknown) => void,
    ) {
        const { slots } = loaded.atlas;
        this.pool = new SlotPool(slots[0] * slots[1] * slots[2]);
        this.tables.set(0, 'there').set(parts.level, 'there');
        for (const column of parts.first) {
            const resident = this.pool.take(column.level, column.x, column.y, column.hasValues, this.wantedKeys);
            if (!resident) break;
            this.pool.pin(columnKey(column.level, column.x, column.y));
            renderer.putBricks(loaded, resident.slots, column.texels);
        }
        this.paint();
    }

    end(): void {
        this.hasEnded = true;
        for (const { abort } of this.flights) abort.abort();
    }

    get detail(): Detail {
        let [missing, coarsest] = [0, 0];
        for (const { level, key } of this.wanted) {
            const isThere = this.isThere(level, key);
            if (!isThere) ++missing;
            coarsest = Math.max(coarsest, isThere ? level : this.parts.level);
        }
        return { missing, coarsest, isGone: this.hasEnded };
    }

    private isThere(level: number, key: string): boolean {
        return level === this.parts.level || this.pool.has(key);
    }

    // Takes another view. Fetches the bricks that this view needs, and stops fetching other bricks.
    look(geometry: ViewGeometry, finest: number): void {
        const { grid } = this.loaded;
        const { pyramid, level } = this.parts;
        const room =
            this.pool.count -
            this.parts.first.reduce((sum, column) => sum + column.hasValues.filter(Boolean).length, 0);
        this.wanted = wantedColumns(
            { geometry, edge: grid.brickEdge, cellSizeM: cellSizeM(grid) },
            pyramid,
            [finest, level],
            room,
        );
        this.wantedKeys = new Set(this.wanted.map(({ key }) => key));
        for (const key of this.wantedKeys) this.pool.use(key);
        this.fetchMore();
    }

    private paint(): void {
        paintPages(this.loaded.atlas.indirection, this.parts.pyramid, this.pool.columns, this.parts.shownOf);
        this.renderer.putIndirection(this.loaded);
    }

    // -- requests

    // Returns the columns with codes from which the texels of a column are made: the column and its neighbors.
    private neighbors({ level, x, y }: WantedColumn): { x: number; y: number; key: string }[] {
        const { columns } = this.parts.pyramid.levels[level]!;
        const found = [];
        for (let nx = Math.max(0, x - 1); nx <= Math.min(columns[0] - 1, x + 1); ++nx) {
            for (let ny = Math.max(0, y - 1); ny <= Math.min(columns[1] - 1, y + 1); ++ny) {
                if (this.bytesOf(level, nx * columns[1] + ny) > 0)
                    found.push({ x: nx, y: ny, key: columnKey(level, nx, ny) });
            }
        }
        return found;
    }

    private bytesOf(level: number, column: number): number {
        const { layers, levels } = this.parts.pyramid;
        const { greatest } = levels[level]!;
        const { brickEdge, codeBytes } = this.loaded.grid;
        let bricks = 0;
        for (let z = 0; z < layers; ++z) if (greatest[column * layers + z]! > 0) ++bricks;
        return bricks * brickEdge ** 3 * codeBytes;
    }

    private fetchMore(): void {
        if (this.hasEnded || performance.now() < this.waitsUntil) return;
        const missing = this.wanted.filter(({ level, key }) => !this.isThere(level, key) && !this.making.has(key));
        const needed = new Map(
            missing.map((column) => [column, this.neighbors(column).filter(({ key }) => !this.cells.has(key))]),
        );
        const neededKeys = new Set([...needed.values()].flat().map(({ key }) => key));
        this.flights = this.flights.filter((flight) => {
            const isNeeded = [...flight.columns].some((key) => neededKeys.has(key));
            if (!isNeeded) flight.abort.abort();
            return isNeeded;
        });
        this.make(missing.filter((column) => needed.get(column)!.length === 0));
        while (this.flights.length < mostFlights) if (!this.fly(missing, needed)) break;
    }

    // Asks for the codes that are needed first. Returns false if there is nothing to ask for now.
    private fly(missing: WantedColumn[], needed: Map<WantedColumn, { x: number; y: number; key: string }[]>): boolean {
        const onTheWay = new Set(this.flights.flatMap(({ columns }) => [...columns]));
        const next = missing.find((column) => needed.get(column)!.some(({ key }) => !onTheWay.has(key)));
        if (!next) return false;
        const { level } = next;
        const table = this.tables.get(level);
        if (!table) this.fetchTable(level);
        if (table !== 'there') return this.flyAnother(missing, needed, level);
        const along = this.parts.pyramid.levels[level]!.columns[1];
        const numbers = new Map<number, string>();
        let bytes = 0;
        for (const column of missing) {
            if (column.level !== level || bytes > mostPlannedBytes) continue;
            for (const { x, y, key } of needed.get(column)!) {
                if (onTheWay.has(key) || numbers.has(x * along + y)) continue;
                numbers.set(x * along + y, key);
                bytes += this.bytesOf(level, x * along + y);
            }
        }
        const weight = (column: number) => this.bytesOf(level, column);
        for (const range of rangesOf(
            [...numbers.keys()],
            this.parts.pyramid.layers,
            weight,
            mostSkippedBytes,
            mostRequestBytes,
        )) {
            if (this.flights.length >= mostFlights) break;
            void this.fetchBricks(level, range);
        }
        return true;
    }

    // Asks for codes of other levels while the table of `level` comes.
    private flyAnother(
        missing: WantedColumn[],
        needed: Map<WantedColumn, { x: number; y: number; key: string }[]>,
        level: number,
    ): boolean {
        const others = missing.filter((column) => column.level !== level);
        return others.length > 0 && this.fly(others, needed);
    }

    // -- answers

    private query(level: number): Record<string, string> {
        const { id } = this.loaded.grid;
        return level > 0 ? { half: String(level), by: 'maximum', id } : { id };
    }

    private fetchTable(level: number): void {
        this.tables.set(level, 'coming');
        const { domain, moment, time, key } = this.parts;
        packed(domain, moment, time, { ...this.query(level), part: 'table' })
            .then((bytes) => this.decoder.ask({ kind: 'table', key, bytes }))
            .then(() => {
                this.tables.set(level, 'there');
                this.fetchMore();
            })
            .catch((error: unknown) => {
                this.tables.delete(level);
                this.stumble(error);
            });
    }

    private async fetchBricks(level: number, range: BrickRange): Promise<void> {
        const { domain, moment, time, key } = this.parts;
        const { layers, levels } = this.parts.pyramid;
        const along = levels[level]!.columns[1];
        const columns = new Map<string, number>();
        for (let number = range.first / layers; number < range.end / layers; ++number) {
            const bytes = this.bytesOf(level, number);
            if (bytes > 0) columns.set(columnKey(level, Math.floor(number / along), number % along), bytes);
        }
        const flight: Flight = { level, columns: new Set(columns.keys()), abort: new AbortController() };
        this.flights.push(flight);
        try {
            const bytes = await packed(
                domain,
                moment,
                time,
                { ...this.query(level), bricks: `${range.first}-${range.end - 1}` },
                flight.abort.signal,
            );
            await this.decoder.ask({ kind: 'bricks', key, bytes });
            for (const [column, size] of columns) this.cells.set(column, size);
            this.failures = 0;
            this.dropCells();
        } catch (error) {
            this.stumble(error);
        }
        this.flights = this.flights.filter((one) => one !== flight);
        this.fetchMore();
    }

    // Drops the oldest codes if the worker holds too many.
    private dropCells(): void {
        let bytes = [...this.cells.values()].reduce((sum, size) => sum + size, 0);
        const columns = [];
        for (const [key, size] of this.cells) {
            if (bytes <= this.mostCells) break;
            bytes -= size;
            this.cells.delete(key);
            const [level, x, y] = key.split('/').map(Number) as [number, number, number];
            columns.push({ level, x, y });
        }
        if (columns.length > 0) void this.decoder.ask({ kind: 'drop', key: this.parts.key, columns });
    }

    private make(columns: WantedColumn[]): void {
        if (columns.length === 0) return;
        for (const { key } of columns) this.making.add(key);
        const asked = columns.map(({ level, x, y }) => ({ level, x, y }));
        this.decoder
            .ask({ kind: 'make', key: this.parts.key, columns: asked })
            .then(({ columns: made }) => {
                for (const { key } of columns) this.making.delete(key);
                if (this.hasEnded) return;
                for (const { level, x, y, hasValues, texels } of made) {
                    // The pool has room for all wanted columns, but a column may no longer be wanted.
                    const resident = this.pool.take(level, x, y, hasValues, this.wantedKeys);
                    if (resident) this.renderer.putBricks(this.loaded, resident.slots, texels);
                }
                this.paint();
                this.changed();
                this.fetchMore();
            })
            .catch((error: unknown) => this.fail(error));
    }

    // Handles a failed request. Ends and shows the error if the grid is gone; otherwise asks again later. Also shows
    // the error after more than mostFailures failures in a row.
    private stumble(error: unknown): void {
        if (this.hasEnded || (error instanceof DOMException && error.name === 'AbortError')) return;
        this.hasEnded = isAbsent(error);
        if (++this.failures > mostFailures || this.hasEnded) this.fail(error);
        const waitMs = retryMs * Math.min(this.failures, mostFailures);
        this.waitsUntil = performance.now() + waitMs;
        window.setTimeout(() => this.fetchMore(), waitMs + 1);
    }
}

// Streams the shown grids that are in parts. Panes that show the same grid share its bricks.
export class Streaming {
    private streams = new Map<LoadedGrid, Stream>();

    constructor(
        private renderer: Renderer,
        private decoder: Decoder,
        private mostCells: () => number, // bytes of codes that the worker keeps for a grid
        private changed: () => void,
        private fail: (error: unknown) => void,
    ) {}

    // Call after the textures of the renderer are lost.
    forget(): void {
        for (const stream of this.streams.values()) stream.end();
        this.streams.clear();
    }

    // Call after Renderer::show() with the same grids.
    show(shown: readonly LoadedGrid[]): void {
        for (const [loaded, stream] of this.streams) {
            if (shown.includes(loaded) && !stream.hasEnded) continue;
            stream.end();
            this.streams.delete(loaded);
        }
        for (const loaded of shown) {
            if (!loaded.stream || this.streams.has(loaded)) continue;
            const { renderer, decoder, changed, fail } = this;
            this.streams.set(
                loaded,
                new Stream(loaded, loaded.stream, renderer, decoder, this.mostCells(), changed, fail),
            );
        }
    }

    // Fetches bricks of a grid for a view. `finest` is the level of the finest bricks that the view wants.
    look(loaded: LoadedGrid, geometry: ViewGeometry, finest: number): void {
        this.streams.get(loaded)?.look(geometry, finest);
    }

    // Returns which bricks of a shown grid have come; null if the grid is whole.
    detail(loaded: LoadedGrid): Detail | null {
        return this.streams.get(loaded)?.detail ?? null;
    }
    // Returns the number of columns of bricks that have not come.
    get missing(): number {
        return [...this.streams.values()].reduce((sum, { detail }) => sum + detail.missing, 0);
    }
}
