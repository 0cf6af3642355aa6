// Decodes a grid and makes its atlas, away from the page's thread.

import { Atlas, coverageOf, makeAtlas } from './atlas';
import { PackedGrid, readPackedGrid } from '../wire/packed_grid';

export interface AtlasRequest {
    number: number;
    bytes: ArrayBuffer;
    mostTexels: number;
}
export interface AtlasAnswer {
    number: number;
    error?: string;
    grid?: PackedGrid;
    atlas?: Atlas;
    coverage?: Uint8Array;
}

self.onmessage = (event: MessageEvent<AtlasRequest>) => {
    const { number, bytes, mostTexels } = event.data;
    const answer: AtlasAnswer = { number };
    try {
        answer.grid = readPackedGrid(new Uint8Array(bytes));
        answer.atlas = makeAtlas(answer.grid, mostTexels);
        answer.coverage = coverageOf(answer.grid);
    } catch (error) {
        answer.error = error instanceof Error ? error.message : String(error);
        (self as unknown as Worker).postMessage({ number, error: answer.error });
        return;
    }
    // The same buffer may hold codes and states.
    const buffers = [answer.atlas.texels, answer.coverage, answer.grid.codes, answer.grid.states].map(array => array.buffer);
    (self as unknown as Worker).postMessage(answer, [...new Set(buffers)]);
};
