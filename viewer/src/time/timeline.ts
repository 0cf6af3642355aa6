// The times of the chosen domain and moment, of stored grids and of frames between them, and the one to show.

import { instantsBetween } from './between';
import { PlayerState, followed, nearestTime, stopped, withTimes } from './player';

export const toleratedFutureMs = 10 * 60 * 1000; // as base/utc_time.h has it
export const isAhead = (ageS: number): boolean => 1000 * ageS < -toleratedFutureMs;

export class Timeline {
    player: PlayerState;
    stored: string[] = []; // times of the domain's grids
    private missing = new Set<string>(); // instants between them for which there is no frame

    // `betweenS`: seconds from one frame between volumes to the next; 0: there are none. A time beyond `believedMs` is
    // of a radar whose clock is wrong.
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
    // Returns the time to follow: one in the future only if all are.
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

    // Forgets the times, because another domain or moment is chosen. Its times come with take().
    forget(): void {
        this.missing.clear();
        this.player = { ...this.player, times: [], at: -1 };
    }
    take(stored: string[]): void {
        this.stored = stored;
        const betweenS = this.betweenS();
        const times = betweenS > 0 ? instantsBetween(stored, betweenS, this.missing) : stored;
        this.player = withTimes(this.player, times, this.newestOf(times));
    }
    follow(): void {
        this.player = followed(this.player, this.newestOf(this.player.times));
    }
    // Goes to the time nearest to the wanted one. Returns false if that is in another second.
    find(wanted: string): boolean {
        this.player = { ...this.player, at: nearestTime(this.player.times, wanted) };
        const second = (time: string) => Math.floor(Date.parse(time) / 1000);
        return this.now === undefined || second(this.now) === second(wanted);
    }
    // Leaves out a time without a grid: a frame near an end or in a gap, or an evicted grid of a loop. Returns false if
    // the time stays.
    leaveOut(time: string): boolean {
        const isBetween = this.isBetween(time);
        if (!isBetween && !this.player.isPlaying) return false;
        this.missing.add(time);
        this.take(this.stored.filter((one) => isBetween || one !== time));
        return true;
    }
}
