// Steps and plays through the times, and follows the newest.

import { CutNumber } from '../fields/sweep_choice';
import { advanced, at, dwellMs, looped, nextOf, stepped } from '../time/player';
import { App } from './app';
import { texts } from './texts';

const soonMs = 20; // playback waits for a picture that is being drawn

export class Playback {
    framesASecond = 4;
    private timer = 0;
    private changedAtMs = 0; // when playback went to another time or sweep

    constructor(private app: App) {}

    // Sets the seconds between frames that are made between volumes; 0 shows volumes only.
    async setBetween(seconds: number): Promise<void> {
        const { app } = this;
        app.miss('');
        const shown = app.timeline.now;
        app.state.betweenS = seconds;
        app.timeline.take(app.timeline.stored);
        if (shown !== undefined && !app.player.follows) app.timeline.find(shown);
        await app.showing.showTime();
    }

    goTo(index: number): void {
        const { app } = this;
        app.miss('');
        app.nextCut = undefined;
        app.player = at(app.player, index);
        void app.showing.showTime();
    }
    step(by: 1 | -1): void {
        const { app } = this;
        app.miss('');
        if (this.stepWithin(by)) return;
        const before = app.player.at;
        app.player = stepped(app.player, by);
        // At the first and the last time, keep the sweep.
        if (app.player.at === before) app.nextCut = undefined;
        void app.showing.showTime(undefined, by);
    }
    // Shows the next sweep of the shown tilt in the shown volume, in 2D, and stops playback and following. Returns
    // false if there is no other sweep.
    private stepWithin(by: 1 | -1): boolean {
        const { app } = this;
        const number = this.nextRepeat(by);
        if (number === undefined) return false;
        app.player = { ...app.player, isPlaying: false, follows: false };
        app.state.time = app.shown?.time ?? app.state.time;
        app.tell('time');
        this.showRepeat(number);
        return true;
    }
    // Returns the number of the next sweep of the shown tilt in the shown volume; undefined if there is none. If it is
    // undefined, the next volume begins with its first sweep of the tilt, or with the last sweep (`by` is -1).
    private nextRepeat(by: 1 | -1): CutNumber | undefined {
        const { app } = this;
        const repeats = app.repeats();
        app.nextCut = repeats ? (by > 0 ? 'first' : null) : undefined;
        return repeats?.numbers[repeats.at + by];
    }
    private showRepeat(sweepNumber: CutNumber): void {
        const { app } = this;
        const at = app.repeats()?.numbers.indexOf(sweepNumber) ?? -1;
        app.setLayers((layers, pane) => {
            const { numbers } = app.repeats(pane) ?? { numbers: [] };
            const isOwn = pane === app.state.active || sweepNumber === 'first';
            const own = isOwn ? sweepNumber : numbers[Math.min(at, numbers.length - 1)];
            return own === undefined || layers.sweepDeg === null ? layers : { ...layers, sweepNumber: own };
        });
        this.changedAtMs = performance.now();
        app.changed();
    }
    follow(): void {
        const { app } = this;
        app.miss('');
        app.nextCut = app.repeats() ? null : undefined;
        app.timeline.follow();
        void app.showing.showTime();
    }
    play(): void {
        const { app } = this;
        app.miss('');
        app.player = { ...app.player, isPlaying: !app.player.isPlaying, follows: false };
        app.nextCut = undefined;
        app.tell('time');
        if (app.player.isPlaying) {
            app.showing.ahead.load();
            this.tick();
        }
    }

    private tick(): void {
        const { app } = this;
        if (!app.player.isPlaying) return;
        if (app.isDrawing()) return this.tickAfter(soonMs);
        const isReady = app.showing.coming === 0 && app.isShownWhole();
        const repeat = isReady ? this.nextRepeat(1) : undefined;
        if (repeat !== undefined) this.showRepeat(repeat);
        // A loop of one volume begins again with the first sweep.
        else if (isReady && app.nextCut === 'first' && nextOf(app.player) === null) this.showRepeat('first');
        const { player, waitsFor } =
            isReady && repeat === undefined && performance.now() - this.changedAtMs >= dwellMs(app.player)
                ? advanced(app.player, (time) => app.showing.ahead.has(time))
                : { player: app.player, waitsFor: null };
        if (app.showing.coming > 0) app.say(texts.waiting(app.timeline.now ?? ''), false);
        if (waitsFor !== null) {
            app.say(texts.waiting(waitsFor));
            const isLeft = app.showing.whetherLeft();
            app.showing.ahead
                .take(waitsFor, false)
                .catch(
                    (error: unknown) =>
                        app.showing.leaveOut(waitsFor, error, isLeft) ||
                        app.showing.failed(error, app.player.isPlaying && !isLeft()),
                );
        } else if (player !== app.player) {
            app.player = player;
            this.changedAtMs = performance.now();
            void app.showing.showTime();
        }
        this.tickAfter(1000 / this.framesASecond);
    }
    private tickAfter(ms: number): void {
        window.clearTimeout(this.timer);
        this.timer = window.setTimeout(() => this.tick(), ms);
    }
    // Sets one end of the loop to a time of the timeline.
    setLoop(end: 'from' | 'to', index = this.app.player.at): void {
        const { app } = this;
        app.timeline.last = 0;
        app.player = looped(app.player, end, index);
        app.tell('time');
    }
    // Keeps playback to so many of the newest volumes; 0 plays all times.
    playLast(count: number): void {
        this.app.timeline.playLast(count);
        this.app.tell('time');
    }
}
