// Fits the first view of a domain to its storms, as `stormcellar frame` does, unless the address names a view. The page
// asks the server for the view while the grid is on its way, and waits for the view only for a short time, so that a
// slow answer does not hold back the first picture.

import { cameraOfFitted } from '../scene/fitted';
import { boxOf } from '../scene/grid_box';
import { FittedView, fittedView, isRegion } from '../wire/api';
import { App, Shown } from './app';
import { Drawing } from './drawing';

const mostWaitMs = 1000;

export class Fitting {
    private asked: { domain: string; view: Promise<FittedView | null>; width: number; height: number } | null = null;

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {
        app.on('choices', () => this.ask());
        const others = app.alongside;
        app.alongside = (next, isAhead) => {
            const other = others(next, isAhead);
            const fitted = isAhead ? null : this.fit(next);
            return other && fitted ? Promise.all([other, fitted]).then(() => undefined) : (other ?? fitted);
        };
    }

    private ask(): void {
        const { app } = this;
        const { domain, moment, time, isFlat } = app.state;
        if (!app.wantsFit || isFlat || domain === '' || isRegion(domain)) return;
        const place = this.drawing.places[0]!;
        const [width, height] = [place.width, place.height].map((side) =>
            Math.min(8192, Math.max(16, Math.round(side))),
        ) as [number, number];
        // Without an answer, the page keeps its usual view.
        const view = fittedView(domain, moment, time, width, height).catch(() => null);
        this.asked = { domain, view, width, height };
    }

    // Returns a promise that resolves when the view is fitted; null if it need not be.
    private fit(next: Shown): Promise<void> | null {
        const { app, asked } = this;
        if (!app.wantsFit || asked?.domain !== next.domain) return null;
        this.asked = null;
        const late = new Promise<null>((done) => window.setTimeout(() => done(null), mostWaitMs));
        return Promise.race([asked.view, late]).then((view) => {
            const isLeft = app.state.domain !== next.domain; // the user chose another domain meanwhile
            if (!app.wantsFit || isLeft) return;
            app.wantsFit = false;
            if (!view?.has_echo) return;
            const camera = cameraOfFitted(view, boxOf(next.loaded.grid), asked.width, asked.height);
            app.fit({ camera, exaggeration: view.exaggeration, opacity: view.opacity });
        });
    }
}
