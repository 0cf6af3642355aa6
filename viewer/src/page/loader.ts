// Loads grids, decodes them in a worker, and keeps the most recently used grids within a budget.
//
// If a grid is too large, loads its table and a halved grid that is small enough. page/streaming.ts then fetches the
// bricks that the view needs.

import { Atlas, paddedEdge, rangeOfCodes } from '../atlas/atlas';
import { brickTexelBytes } from '../atlas/brick_store';
import { Decoder } from '../atlas/decoder';
import { levelWithin } from '../atlas/pyramid';
import { GridTable } from '../atlas/worker';
import { LoadedGrid } from '../atlas/loaded_grid';
import { GridPlace, readPlace } from '../wire/packed_grid';
import { isRegion, packed, packedBetween } from '../wire/api';

// Divides the memory for grids.
export class Budget {
    readonly mostWhole: number; // most uncompressed bytes of a grid; a larger grid is fetched in parts
    panes = 1; // number of panes that share the memory for grids in parts

    constructor(
        readonly bytes: number,
        private mostTexels: number,
    ) {
        this.mostWhole = Math.floor(0.1 * bytes);
    }

    // Divides the memory for grids in parts among panes. Returns false if the memory is already divided among this many
    // panes.
    divide(panes: number): boolean {
        const isOther = panes !== this.panes;
        this.panes = panes;
        return isOther;
    }
    get bytesOfPane(): number {
        return this.bytes / this.panes;
    }
    // Returns the number of slots along each side of the atlas for grids in parts.
    get poolSide(): number {
        const slots = (0.36 * this.bytesOfPane) / brickTexelBytes;
        return Math.max(2, Math.min(Math.floor(Math.cbrt(slots)), Math.floor(this.mostTexels / paddedEdge)));
    }
    // Returns the bytes of codes that the worker keeps for a grid in parts.
    get mostCells(): number {
        return 0.19 * this.bytesOfPane;
    }
    // Returns the most bricks of the halved grid that is fetched first.
    get mostFirst(): number {
        return 0.15 * this.poolSide ** 3;
    }
}

function arrayBytes(...arrays: ArrayBufferView[]): number {
    return arrays.reduce((sum, array) => sum + array.byteLength, 0);
}

function bytesOf({ grid, atlas, coverage, stream }: LoadedGrid): number {
    const table = arrayBytes(grid.kind, grid.state, grid.valueCount, grid.leastCode, grid.greatestCode, grid.block);
    let bytes = table + arrayBytes(atlas.texels, atlas.indirection, atlas.blocks, coverage, grid.codes, grid.states);
    if (stream) {
        for (const level of stream.pyramid.levels) bytes += arrayBytes(level.greatest, level.about, level.shown);
        for (const column of stream.first) bytes += column.texels.byteLength;
    }
    return bytes;
}

// Returns an empty atlas for a grid in parts.
function poolAtlas({ grid, pyramid, shown }: GridTable, side: number): Atlas {
    const { scale, offset } = shown;
    const [least, greatest] = rangeOfCodes(grid);
    return {
        size: [side * paddedEdge, side * paddedEdge, side * paddedEdge],
        slots: [side, side, side],
        brickCount: pyramid.levels[0]!.shown.some((count) => count > 0) ? side ** 3 : 0,
        texels: new Uint8Array(0),
        indirection: new Uint32Array(grid.kind.length),
        bricks: grid.bricks,
        codeScale: scale,
        codeOffset: offset,
        least,
        greatest,
        histogram: new Uint32Array(256),
        blocks: new Uint8Array(0),
    };
}

export class Loader {
    readonly decoder = new Decoder();
    private kept = new Map<string, LoadedGrid>(); // the least recently used first
    private loading = new Map<string, Promise<LoadedGrid>>();

    besides: () => number = () => 0; // returns the bytes of windows of grids in parts

    // Called with the place of a grid while the grid is decoded.
    onPlace: ((domain: string, place: GridPlace) => void) | null = null;

    constructor(
        readonly budget: Budget,
        private mostTexels: number,
    ) {}

    static key(domain: string, moment: string, time: string): string {
        return `${domain}/${moment}/${time}`;
    }

    find(key: string): LoadedGrid | undefined {
        const found = this.kept.get(key);
        if (found) {
            this.kept.delete(key);
            this.kept.set(key, found);
        }
        return found;
    }
    has(key: string): boolean {
        return this.kept.has(key);
    }
    // Forgets a grid that was made again, so that the next load asks for it.
    forget(key: string): void {
        const old = this.kept.get(key);
        this.kept.delete(key);
        // Ignore the result of a load that has begun, because it may be the old grid.
        this.loading.delete(key);
        if (old?.stream) void this.decoder.ask({ kind: 'forget', key });
    }

    forgetAll(isOld: (key: string) => boolean): void {
        for (const key of [...this.kept.keys(), ...this.loading.keys()]) if (isOld(key)) this.forget(key);
    }

    load(domain: string, moment: string, time: string, isBetween = false): Promise<LoadedGrid> {
        const key = Loader.key(domain, moment, time);
        const kept = this.find(key);
        if (kept) return Promise.resolve(kept);
        let loading = this.loading.get(key);
        if (!loading) {
            const isNewest = () => this.loading.get(key) === mine;
            const mine = this.fetch(domain, moment, time, isBetween).then((loaded) => {
                if (isNewest()) this.keep(key, loaded);
                return loaded;
            });
            loading = mine;
            this.loading.set(key, mine);
            const end = () => isNewest() && this.loading.delete(key);
            mine.then(end, end);
        }
        return loading;
    }

    private async fetch(domain: string, moment: string, time: string, isBetween: boolean): Promise<LoadedGrid> {
        const key = Loader.key(domain, moment, time);
        const bytes = await (isBetween || isRegion(domain)
            ? packedBetween(domain, moment, time)
            : packed(domain, moment, time, { most: String(this.budget.mostWhole), codes: 'values' }));
        const place = readPlace(new Uint8Array(bytes));
        const decoded = this.decoder.ask({ kind: 'grid', key, bytes, mostTexels: this.mostTexels });
        this.onPlace?.(domain, place);
        const answer = await decoded;
        return 'atlas' in answer ? { ...answer, stream: null } : this.fetchFirst(domain, moment, time, answer);
    }

    // Fetches the halved grid that is shown until finer bricks come.
    private async fetchFirst(domain: string, moment: string, time: string, table: GridTable): Promise<LoadedGrid> {
        const key = Loader.key(domain, moment, time);
        const { grid, pyramid, shown } = table;
        const level = Math.max(1, levelWithin(pyramid, this.budget.mostFirst));
        const bytes = await packed(domain, moment, time, {
            half: String(level),
            by: 'maximum',
            id: grid.id,
            codes: 'values',
        });
        const { columns, coverage, histogram, isClear } = await this.decoder.ask({ kind: 'level', key, bytes });
        const atlas = { ...poolAtlas(table, this.budget.poolSide), histogram };
        const stream = {
            key,
            domain,
            moment,
            time,
            pyramid,
            shownOf: shown.table,
            level,
            first: columns,
            isClear,
        };
        return { grid, atlas, coverage, stream };
    }

    // Divides the memory among panes. Forgets grids in parts, whose atlases then have another size.
    divide(panes: number): void {
        if (!this.budget.divide(panes)) return;
        for (const [key, { stream }] of [...this.kept]) if (stream) this.forget(key);
    }

    // Returns the bytes of all grids, with the atlas, the codes and the windows of grids in parts.
    get bytes(): number {
        const all = [...this.kept.values()];
        const parts = all.find(({ stream }) => stream);
        const pools = parts
            ? this.budget.panes * (2 * parts.atlas.size[0] ** 3 + this.budget.mostCells) + this.besides()
            : 0;
        return all.reduce((sum, one) => sum + bytesOf(one), pools);
    }

    private keep(key: string, loaded: LoadedGrid): void {
        this.kept.set(key, loaded);
        document.documentElement.dataset['loaded'] = String(this.kept.size);
        for (const old of [...this.kept.keys()]) {
            if (this.bytes <= this.budget.bytes || old === key) break;
            this.forget(old);
        }
    }
}
