// The times of the domain and moment that are chosen, and which of them is to be shown: those of stored grids, and of
// frames between them.

import { instantsBetween } from './between';
import { PlayerState, followed, nearestTime, stopped, withTimes } from './player';

export const toleratedFutureMs = 10 * 60 * 1000; // as base/utc_time.h has it
export const isAhead = (ageS: number): boolean => 1000 * ageS < -toleratedFutureMs;

export class Timeline {
    player: PlayerState;
    stored: string[] = []; // times of the domain's grids
    private missing = new Set<string>(); // instants between them for which there is no frame

    // `betweenS`: seconds from one frame between volumes to the next; 0: there are none. `believedMs`: of a time beyond
    // it the clock of a radar is wrong.
    constructor(
        follows: boolean,
        private betweenS: () => number,
        private believedMs: () => number,
    ) {
        this.player = { ...stopped, follows };
    }

    // The time that is to be shown.
    get now(): string | undefined {
        return this.player.times[this.player.at];
    }
    // The one that is followed: a wrong time in the future only if all are.
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

    // Another domain or moment is chosen: its times come with take().
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
    // The time that is nearest to the wanted one. Returns false if the page tells it as another.
    find(wanted: string): boolean {
        this.player = { ...this.player, at: nearestTime(this.player.times, wanted) };
        const second = (time: string) => Math.floor(Date.parse(time) / 1000);
        return this.now === undefined || second(this.now) === second(wanted);
    }
    // Near the ends and in gaps there is no frame between volumes, and a loop may meet a grid that was evicted: the
    // time is left out. Returns false if it is not.
    leaveOut(time: string): boolean {
        const isBetween = this.isBetween(time);
        if (!isBetween && !this.player.isPlaying) return false;
        this.missing.add(time);
        this.take(this.stored.filter((one) => isBetween || one !== time));
        return true;
    }
}
