// Asks the server for facts of the shown grid, and keeps the answers until another grid is shown.

import { LoadedGrid } from '../atlas/loaded_grid';
import { GridFacts, RegionSites, gridFacts, isRegion, regionSites } from '../wire/api';
import { App } from './app';

export class FactsOfShown {
    private of: LoadedGrid | null = null;
    private facts: GridFacts | null = null;
    private asking: Promise<GridFacts> | null = null;
    private sitesOf: LoadedGrid | null = null;
    private regionSites: RegionSites | null = null;
    private askingSites: Promise<void> = Promise.resolve();

    constructor(private app: App) {}

    // Returns the facts if they have come; null otherwise.
    get known(): GridFacts | null {
        return this.of !== null && this.of === this.app.shown?.loaded ? this.facts : null;
    }

    // Returns the sites of the shown region; null until they have come, and if no region is shown.
    get sites(): RegionSites | null {
        return this.sitesOf !== null && this.sitesOf === this.app.shown?.loaded ? this.regionSites : null;
    }
    askSites(): Promise<void> {
        const { shown } = this.app;
        if (!shown || !isRegion(shown.domain)) return Promise.resolve();
        if (this.sitesOf === shown.loaded) return this.askingSites;
        const of = (this.sitesOf = shown.loaded);
        this.regionSites = null;
        this.askingSites = regionSites(shown.domain, shown.moment, shown.time).then(
            (found) => {
                if (this.sitesOf === of) this.regionSites = found;
            },
            (error: unknown) => {
                if (this.sitesOf === of) this.sitesOf = null;
                throw error;
            },
        );
        return this.askingSites;
    }

    ask(): Promise<GridFacts> {
        const { shown } = this.app;
        if (!shown || isRegion(shown.domain)) return Promise.reject(new Error());
        if (this.of !== shown.loaded || !this.asking) {
            const of = (this.of = shown.loaded);
            this.facts = null;
            this.asking = gridFacts(shown.domain, shown.moment, shown.time);
            this.asking.then(
                (facts) => {
                    if (this.of === of) this.facts = facts;
                },
                () => {
                    if (this.of === of) this.asking = null;
                },
            );
        }
        return this.asking;
    }
}
