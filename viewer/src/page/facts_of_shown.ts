// What the server says of the grid that is shown, asked once for each grid.

import { GridFacts, gridFacts } from '../wire/api';
import { App } from './app';

export class FactsOfShown {
    private key = '';
    private facts: GridFacts | null = null;
    private asking: Promise<GridFacts> | null = null;

    constructor(private app: App) {}

    // What is known already; null otherwise.
    get known(): GridFacts | null {
        return this.key === this.app.shown?.key ? this.facts : null;
    }

    ask(): Promise<GridFacts> {
        const { shown } = this.app;
        if (!shown) return Promise.reject(new Error());
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
