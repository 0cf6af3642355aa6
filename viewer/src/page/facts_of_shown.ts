// What the server says of the grid that is shown, asked once for each grid.

import { GridFacts, RegionSite, gridFacts, isRegion, regionSites } from '../wire/api';
import { App } from './app';

export class FactsOfShown {
    private key = '';
    private facts: GridFacts | null = null;
    private asking: Promise<GridFacts> | null = null;
    private sitesKey = '';
    private regionSites: RegionSite[] | null = null;
    private askingSites: Promise<void> = Promise.resolve();

    constructor(private app: App) {}

    // What is known already; null otherwise.
    get known(): GridFacts | null {
        return this.key === this.app.shown?.key ? this.facts : null;
    }

    // The sites of the region that is shown; null for what is no region, and until they are known.
    get sites(): RegionSite[] | null {
        return this.sitesKey === this.app.shown?.key ? this.regionSites : null;
    }
    askSites(): Promise<void> {
        const { shown } = this.app;
        if (!shown || !isRegion(shown.domain)) return Promise.resolve();
        if (this.sitesKey === shown.key) return this.askingSites;
        const key = (this.sitesKey = shown.key);
        this.regionSites = null;
        this.askingSites = regionSites(shown.domain, shown.moment, shown.time).then(found => {
            if (this.sitesKey === key) this.regionSites = found;
        });
        return this.askingSites;
    }

    ask(): Promise<GridFacts> {
        const { shown } = this.app;
        if (!shown || isRegion(shown.domain)) return Promise.reject(new Error());
        if (this.key !== shown.key || !this.asking) {
            const key = (this.key = shown.key);
            this.facts = null;
            this.asking = gridFacts(shown.domain, shown.moment, shown.time);
            this.asking.then(
                facts => {
                    if (this.key === key) this.facts = facts;
                },
                () => undefined,
            );
        }
        return this.asking;
    }
}
