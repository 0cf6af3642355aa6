// Loads grids, decodes them in a worker and keeps those that were used last, within a budget.

import { AtlasAnswer, AtlasRequest } from '../atlas/worker';
import { LoadedGrid } from '../renderer/renderer';
import { packed, packedBetween } from '../wire/api';

const mostBytes = 256 * 2 ** 20;

function bytesOf(loaded: LoadedGrid): number {
    return loaded.atlas.texels.byteLength + loaded.coverage.byteLength + loaded.grid.codes.byteLength + loaded.grid.states.byteLength;
}

export class Loader {
    private worker = new Worker('worker.js');
    private waiting = new Map<number, (answer: AtlasAnswer) => void>();
    private kept = new Map<string, LoadedGrid>(); // the least recently used first
    private loading = new Map<string, Promise<LoadedGrid>>();
    private count = 0;

    constructor(private mostTexels: number) {
        this.worker.onmessage = (event: MessageEvent<AtlasAnswer>) => {
            const done = this.waiting.get(event.data.number);
            this.waiting.delete(event.data.number);
            done?.(event.data);
        };
    }

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
    // A grid was made again: the next load asks for it.
    forget(key: string): void {
        this.kept.delete(key);
    }

    load(domain: string, moment: string, time: string, isBetween = false): Promise<LoadedGrid> {
        const key = Loader.key(domain, moment, time);
        const kept = this.find(key);
        if (kept) return Promise.resolve(kept);
        let loading = this.loading.get(key);
        if (!loading) {
            loading = this.decode(domain, moment, time, isBetween).finally(() => this.loading.delete(key));
            this.loading.set(key, loading);
        }
        return loading;
    }

    private async decode(domain: string, moment: string, time: string, isBetween: boolean): Promise<LoadedGrid> {
        const bytes = await (isBetween ? packedBetween : packed)(domain, moment, time);
        const request: AtlasRequest = { number: ++this.count, bytes, mostTexels: this.mostTexels };
        const answer = await new Promise<AtlasAnswer>(resolve => {
            this.waiting.set(request.number, resolve);
            this.worker.postMessage(request, [bytes]);
        });
        if (answer.error !== undefined || !answer.grid || !answer.atlas || !answer.coverage) throw new Error(answer.error ?? 'the grid was not decoded');
        const loaded: LoadedGrid = { grid: answer.grid, atlas: answer.atlas, coverage: answer.coverage };
        this.keep(Loader.key(domain, moment, time), loaded);
        return loaded;
    }

    private keep(key: string, loaded: LoadedGrid): void {
        this.kept.set(key, loaded);
        let bytes = 0;
        for (const one of this.kept.values()) bytes += bytesOf(one);
        for (const [old, one] of this.kept) {
            if (bytes <= mostBytes || old === key) break;
            bytes -= bytesOf(one);
            this.kept.delete(old);
        }
    }
}
