// Steps and plays through the times, and follows the newest.

import { advanced, at, looped, stepped } from '../time/player';
import { App } from './app';
import { texts } from './texts';

export class Playback {
    framesASecond = 4;
    private timer = 0;

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
        app.player = at(app.player, index);
        void app.showing.showTime();
    }
    step(by: number): void {
        const { app } = this;
        app.miss('');
        app.player = stepped(app.player, by);
        void app.showing.showTime(undefined, by);
    }
    follow(): void {
        const { app } = this;
        app.miss('');
        app.timeline.follow();
        void app.showing.showTime();
    }
    play(): void {
        const { app } = this;
        app.miss('');
        app.player = { ...app.player, isPlaying: !app.player.isPlaying, follows: false };
        app.tell('time');
        if (app.player.isPlaying) {
            app.showing.ahead.load();
            this.tick();
        }
    }

    private tick(): void {
        const { app } = this;
        if (!app.player.isPlaying) return;
        const { player, waitsFor } =
            app.showing.coming === 0 && app.isShownWhole()
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
            void app.showing.showTime();
        }
        window.clearTimeout(this.timer);
        this.timer = window.setTimeout(() => this.tick(), 1000 / this.framesASecond);
    }
    // Sets one end of the loop to the current time. With null, ends the loop, so that all times are played.
    setLoop(end: 'from' | 'to' | null): void {
        const { app } = this;
        app.player = end ? looped(app.player, end) : { ...app.player, loop: null };
        app.tell('time');
    }
}
