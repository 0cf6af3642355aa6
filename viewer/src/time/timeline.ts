// Keeps the times of the chosen domain and moment, of stored grids and of frames between them, and the time to show.

import { instantsBetween } from './between';
import { PlayerState, followed, nearestTime, stopped, withTimes } from './player';

export const toleratedFutureMs = 10 * 60 * 1000; // as in base/utc_time.h
export const isAhead = (ageS: number): boolean => 1000 * ageS < -toleratedFutureMs;

export class Timeline {
    player: PlayerState;
    stored: string[] = []; // times of the domain's grids
    last = 0; // playback keeps to this many of the newest stored times; 0: see PlayerState.loop
    private missing = new Set<string>(); // times without a grid

    // `betweenS` returns the seconds between frames that are made between volumes, or 0 without such frames.
    // `believedMs` returns the latest time that can be right; later times come from a radar whose clock is wrong.
    constructor(
        follows: boolean,
        private betweenS: () => number,
        private believedMs: () => number,
    ) {
        this.player = { ...stopped, follows };
    }

    // Returns the time to show.
    get now(): string | undefined {
        return this.player.times[this.player.at];
    }
    // Returns the newest time up to `believedMs`; the newest of all if every time is later.
    get newest(): string | undefined {
        return this.player.times[this.newestOf(this.player.times)];
    }
    private newestOf(times: string[]): number {
        let last = times.length - 1;
        while (last >= 0 && Date.parse(times[last]!) > this.believedMs()) --last;
        return last < 0 ? times.length - 1 : last;
    }
    isBetween(time: string): boolean {
        return this.betweenS() > 0 && !this.stored.includes(time);
    }

    // Call when another domain or moment is chosen. Its times come with take().
    forget(): void {
        this.missing.clear();
        this.player = { ...this.player, times: [], at: -1 };
    }
    take(stored: string[]): void {
        this.stored = stored;
        const betweenS = this.betweenS();
        const times = betweenS > 0 ? instantsBetween(stored, betweenS, this.missing) : stored;
        this.player = withTimes(this.player, times, this.newestOf(times));
        this.loopLast();
    }
    // Makes playback keep to the newest times, also when newer times come; 0 plays all times.
    playLast(count: number): void {
        this.last = count;
        this.player = { ...this.player, loop: null };
        this.loopLast();
    }
    private loopLast(): void {
        const newest = this.newestOf(this.stored);
        if (this.last === 0 || newest < 0) return;
        const from = this.stored[Math.max(0, newest + 1 - this.last)]!;
        this.player = { ...this.player, loop: { from, to: this.stored[newest]! } };
    }
    follow(): void {
        this.player = followed(this.player, this.newestOf(this.player.times));
    }
    // Goes to the time nearest to `wanted`. Returns false if the nearest time is in another second than `wanted`.
    find(wanted: string): boolean {
        this.player = { ...this.player, at: nearestTime(this.player.times, wanted) };
        const second = (time: string) => Math.floor(Date.parse(time) / 1000);
        return this.now === undefined || second(this.now) === second(wanted);
    }
    // Leaves out a time whose grid does not exist: a frame between volumes, or during playback an evicted grid. Returns
    // false if the time stays.
    leaveOut(time: string): boolean {
        const isBetween = this.isBetween(time);
        if (!isBetween && !this.player.isPlaying) return false;
        this.missing.add(time);
        this.take(this.stored.filter((one) => isBetween || one !== time));
        return true;
    }
}
