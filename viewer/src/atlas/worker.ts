// Decodes grids and makes their atlases, in a thread of its own.

import { BrickStore, MadeColumn } from './brick_store';
import { Atlas, ShownCodes, coverageOf, histogramOf, makeAtlas, rangeOfCodes, shownCodes } from './atlas';
import { Pyramid, pyramidOf } from './pyramid';
import { isClearAir } from '../fields/clear_air';
import { PackedGrid, readGridOrTable, readPackedBricks, readPackedGrid } from '../wire/packed_grid';

interface Column {
    level: number;
    x: number;
    y: number;
}

// 'grid' brings a whole grid, or the table of a grid in parts. For a table, the worker makes a store with the name
// `key`, which other requests name: 'level' brings a whole halved grid, 'table' the table of a halved grid, and
// 'bricks' some bricks of a grid whose table came before. 'make' asks for the texels of columns, 'drop' drops the codes
// of columns, and 'forget' drops the store. 'cells' brings a grid that needs no atlas.
export type WorkerRequest =
    | { kind: 'grid'; key: string; bytes: ArrayBuffer; mostTexels: number }
    | { kind: 'level'; key: string; bytes: ArrayBuffer }
    | { kind: 'table'; key: string; bytes: ArrayBuffer }
    | { kind: 'bricks'; key: string; bytes: ArrayBuffer }
    | { kind: 'make'; key: string; columns: Column[] }
    | { kind: 'drop'; key: string; columns: Column[] }
    | { kind: 'forget'; key: string }
    | { kind: 'cells'; bytes: ArrayBuffer };

export interface WholeGrid {
    grid: PackedGrid;
    atlas: Atlas;
    coverage: Uint8Array;
}
export interface GridTable {
    grid: PackedGrid;
    pyramid: Pyramid;
    shown: ShownCodes;
}
export interface WholeLevel {
    columns: MadeColumn[];
    coverage: Uint8Array;
    histogram: Uint32Array;
    isClear: boolean; // result of isClearAir(), which counts for reflectivity only
}
type Nothing = Record<string, never>;

// Types of the answers, by kind of request.
export interface Answers {
    grid: WholeGrid | GridTable;
    level: WholeLevel;
    table: Nothing;
    bricks: Nothing;
    make: { columns: MadeColumn[] };
    drop: Nothing;
    forget: Nothing;
    cells: { grid: PackedGrid };
}
export type WorkerAnswer = Answers[keyof Answers];
export type Numbered<T> = T & { number: number };

const stores = new Map<string, BrickStore>();

function takeGrid(key: string, bytes: ArrayBuffer, mostTexels: number): WholeGrid | GridTable {
    const { grid, isWhole } = readGridOrTable(new Uint8Array(bytes));
    if (isWhole) return { grid, atlas: makeAtlas(grid, mostTexels), coverage: coverageOf(grid) };
    const [least, greatest] = rangeOfCodes(grid);
    const shown = shownCodes(grid, least, greatest);
    const store = new BrickStore(shown);
    store.addLevel(grid);
    stores.set(key, store);
    return { grid, pyramid: pyramidOf(grid), shown };
}

// Stores a whole halved grid, and makes the texels of all its columns with values.
function takeLevel(store: BrickStore, bytes: ArrayBuffer): WholeLevel {
    const grid = readPackedGrid(new Uint8Array(bytes));
    store.addLevel(grid);
    const columns: MadeColumn[] = [];
    for (let x = 0; x < grid.bricks[0]; ++x) {
        for (let y = 0; y < grid.bricks[1]; ++y) {
            const column = store.make(grid.halvings, x, y);
            if (column.texels.length > 0) columns.push(column);
        }
    }
    return {
        columns,
        coverage: coverageOf(grid),
        histogram: histogramOf(grid, store.shown.table),
        isClear: isClearAir(grid),
    };
}

function answerTo(request: WorkerRequest): WorkerAnswer {
    if (request.kind === 'grid') return takeGrid(request.key, request.bytes, request.mostTexels);
    if (request.kind === 'cells') return { grid: readPackedGrid(new Uint8Array(request.bytes)) };
    const store = stores.get(request.key);
    if (!store) throw new Error('the grid is not there any more');
    switch (request.kind) {
        case 'level':
            return takeLevel(store, request.bytes);
        case 'table':
            store.addLevel(readGridOrTable(new Uint8Array(request.bytes)).grid);
            return {};
        case 'bricks':
            store.addBricks(readPackedBricks(new Uint8Array(request.bytes)));
            return {};
        case 'make':
            return { columns: request.columns.map(({ level, x, y }) => store.make(level, x, y)) };
        case 'drop':
            for (const { level, x, y } of request.columns) store.drop(level, x, y);
            return {};
        case 'forget':
            stores.delete(request.key);
            return {};
    }
}

// Returns the buffers that move to the page without a copy. Codes and states may share a buffer, which is listed once.
function buffersOf(answer: WorkerAnswer): ArrayBufferLike[] {
    const arrays: Uint8Array[] = 'columns' in answer ? answer.columns.map((column) => column.texels) : [];
    if ('atlas' in answer) arrays.push(answer.atlas.texels);
    if ('grid' in answer) arrays.push(answer.grid.states, answer.grid.codes as Uint8Array);
    if ('coverage' in answer) arrays.push(answer.coverage);
    return [...new Set(arrays.map((array) => array.buffer))];
}

self.onmessage = (event: MessageEvent<Numbered<WorkerRequest>>) => {
    const { number } = event.data;
    try {
        const answer = answerTo(event.data);
        (self as unknown as Worker).postMessage({ number, ...answer }, buffersOf(answer) as ArrayBuffer[]);
    } catch (error) {
        (self as unknown as Worker).postMessage({
            number,
            error: error instanceof Error ? error.message : String(error),
        });
    }
};
