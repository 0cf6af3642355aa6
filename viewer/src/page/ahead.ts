// Loads ahead what is shown next: grids, and the data of layers.

import { nextOf } from '../time/player';
import { App } from './app';
import { Loader } from './loader';

const loadedAhead = 12; // times during playback
const betweenAhead = 3; // times among these whose grids are made on request

export class Ahead {
    constructor(private app: App) {}

    has(time: string): boolean {
        const { app } = this;
        const loaded = app.loader.find(Loader.key(app.state.domain, app.state.moment, time));
        return loaded !== undefined && app.alongside(app.showing.shownOf(time, loaded), true) === null;
    }
    async take(time: string, isAhead: boolean): Promise<void> {
        const { app } = this;
        const isLeft = app.showing.whetherLeft();
        const loaded = await app.showing.load(time);
        if (!isLeft()) await app.alongside(app.showing.shownOf(time, loaded), isAhead);
    }
    // Loads the times before and after the shown time, so that a step shows at once. During playback, loads the next
    // times instead.
    load(): void {
        const { app } = this;
        const { times, at, isPlaying } = app.player;
        const isLeft = app.showing.whetherLeft();
        const next = isPlaying
            ? Array.from({ length: loadedAhead }, (_, i) => nextOf(app.player, i + 1))
            : [at + 1, at - 1];
        // Load grids in parts one at a time, because the server computes their halved grids.
        const isInParts = app.shown?.loaded.stream != null;
        let before = Promise.resolve();
        for (const [i, index] of next.entries()) {
            const time = times[index ?? -1];
            // Load frames between volumes only during playback, and only the next few, because the server makes them on
            // request.
            if (time === undefined || (app.timeline.isBetween(time) && (!isPlaying || i >= betweenAhead))) continue;
            const load = async () => {
                if (!isLeft())
                    await this.take(time, true).catch((error: unknown) => app.showing.leaveOut(time, error, isLeft));
            };
            before = isInParts ? before.then(load) : load();
        }
    }
}
