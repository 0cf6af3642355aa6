// Shows the wanted time of the chosen domain and moment. Loads the grid and the data of its layers, and goes to another
// time if there is no grid.

import { LoadedGrid } from '../atlas/loaded_grid';
import { isClearAir } from '../fields/clear_air';
import { at } from '../time/player';
import { ApiError, times } from '../wire/api';
import { Ahead } from './ahead';
import { App, Shown } from './app';
import { Loader } from './loader';
import { texts } from './texts';

export const soonTimes = 500; // the page asks first for this many of the newest times
export const mostTimes = 10000; // most times in an answer of the server

export class Showing {
    readonly ahead = new Ahead(this.app);
    coming = 0; // number of calls of showTime() that have not ended
    private turn = 0; // number of the last call of showTime()

    constructor(private app: App) {}

    // Shows the error of a failed load. If the page does not want the data any more (`isWanted` is false), shows the
    // error only if the server did not answer.
    failed(error: unknown, isWanted: boolean): void {
        if (isWanted || error instanceof TypeError) this.app.fail(error);
    }

    // Asks for the times of the chosen domain and moment, and shows the wanted time.
    async showChosen(): Promise<void> {
        const { app } = this;
        app.tell('choices');
        app.say(texts.loading);
        this.stayWhoPaused();
        const choice = ++app.choices;
        try {
            const soon = await times(app.state.domain, app.state.moment, soonTimes);
            if (choice !== app.choices) return;
            app.timeline.forget();
            app.timeline.take(soon.times);
            const { time } = app.state;
            // Ask for all times first if the wanted time is before the times of the first answer.
            const isOlder = soon.more && !app.player.follows && Date.parse(time) < Date.parse(soon.times[0] ?? '');
            if (isOlder) await this.findOlder();
            if (!app.player.follows && !app.timeline.find(time)) app.missTime(time);
            await this.showTime(app.player.follows ? undefined : time);
            if (soon.more && !isOlder) await this.findOlder();
        } catch (error) {
            if (choice === app.choices) app.fail(error);
        }
    }
    // If the user has stopped following, but `state.time` is still 'latest', sets `state.time` to the time of the
    // player. If the player has no time, follows again.
    private stayWhoPaused(): void {
        const { app } = this;
        if (app.player.follows || app.state.time !== 'latest') return;
        const now = app.timeline.now;
        if (now === undefined) app.player = { ...app.player, follows: true };
        else app.state.time = now;
    }

    // Adds all older times to the timeline.
    private async findOlder(): Promise<void> {
        const { app } = this;
        const { domain, moment } = app.state;
        const isLeft = this.whetherLeft();
        for (let more = true; more;) {
            const older = await times(domain, moment, mostTimes, app.timeline.stored[0]);
            if (isLeft()) return;
            more = older.more && older.times.length > 1;
            app.timeline.take([
                ...older.times.filter((time) => time < app.timeline.stored[0]!),
                ...app.timeline.stored,
            ]);
            app.tell('time');
        }
    }

    // Returns a function that returns true once another domain or moment is chosen.
    whetherLeft(): () => boolean {
        const { app } = this;
        const { domain, moment } = app.state;
        return () => domain !== app.state.domain || moment !== app.state.moment;
    }
    // Shows the current time of the timeline. If its grid does not exist, leaves the time out and shows another. After
    // a step (`by` is not 0), this is the next time in the same direction. Otherwise it is the time nearest to
    // `nearest`, or without `nearest` to the current time. During playback, or while the page follows the newest, the
    // timeline chooses.
    async showTime(nearest?: string, by = 0): Promise<void> {
        const { app } = this;
        const time = app.timeline.now;
        app.tell('time');
        if (time === undefined) return app.say(texts.notFound(app.state.domain, app.state.moment));
        const wanted = nearest ?? time;
        const [turn, isLeft] = [++this.turn, this.whetherLeft()];
        const isLate = () => turn !== this.turn || app.timeline.now !== time || isLeft();
        ++this.coming;
        try {
            const loaded = await this.load(time);
            // Leave the picture to a later call, which may load a newer version of the same grid.
            if (isLate()) return;
            const next = this.shownOf(time, loaded);
            await app.alongside(next, false);
            if (!isLate()) this.take(next);
        } catch (error) {
            const wasLate = isLate();
            const index = app.player.at;
            if (!this.leaveOut(time, error, isLeft)) return this.failed(error, !wasLate);
            const stays = !wasLate && !app.player.follows && !app.player.isPlaying;
            if (stays && by !== 0) app.player = at(app.player, by > 0 ? index : index - 1);
            else if (stays) app.timeline.find(wanted);
            if (stays && by === 0 && app.missedTime === '') app.missTime(time);
            if (app.timeline.now !== undefined) await this.showTime(stays ? wanted : undefined, by);
        } finally {
            --this.coming;
        }
    }
    shownOf(time: string, loaded: LoadedGrid): Shown {
        const { shown, nextCut, state } = this.app;
        const { domain, moment } = state;
        const key = Loader.key(domain, moment, time);
        const isBetween = this.app.timeline.isBetween(time);
        // Keep the shown picture if it is the same, so that a reading of it stays.
        if (shown?.key === key && shown.loaded === loaded && shown.isBetween === isBetween && nextCut === undefined)
            return shown;
        return { key, loaded, domain, moment, time, isBetween };
    }
    load(time: string): Promise<LoadedGrid> {
        const { app } = this;
        return app.loader.load(app.state.domain, app.state.moment, time, app.timeline.isBetween(time));
    }
    // Leaves out a time if `error` says that its grid does not exist. Returns false if the time stays; the caller then
    // shows the error.
    leaveOut(time: string, error: unknown, isLeft: () => boolean): boolean {
        // A 410 may also mean that a grid in parts was made again while it was loaded.
        const isGone =
            error instanceof ApiError &&
            (error.status === 404 || (error.status === 410 && !error.message.includes('made again')));
        if (isLeft() || !isGone || !this.app.timeline.leaveOut(time)) return false;
        this.app.tell('time');
        return true;
    }

    private take(shown: Shown): void {
        const { app } = this;
        const { book } = app;
        // Choose the colors for clear air or for storms, but keep them during playback of one domain. The first halved
        // grid decides for a grid in parts.
        const isOther = app.shown?.domain !== shown.domain || !app.player.isPlaying;
        const loaded = [shown, ...app.beside(shown)].find((one) => one?.moment === 'REF')?.loaded;
        if (book && isOther)
            book.isClearAir = loaded !== undefined && (loaded.stream?.isClear ?? isClearAir(loaded.grid));
        app.shown = shown;
        const { nextCut } = app;
        if (nextCut !== undefined) app.setLayers((layers) => ({ ...layers, sweepNumber: nextCut }));
        app.nextCut = undefined;
        app.unreadTime = '';
        app.state.time = app.player.follows ? 'latest' : shown.time;
        this.ahead.load();
        app.tell('shown');
        app.changed();
    }

    restore(): void {
        const { app } = this;
        app.tell('restored');
        if (app.shown) this.take(app.shown);
    }
}
