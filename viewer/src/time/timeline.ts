// The times of the domain and moment that are chosen, and which of them is to be shown: those of stored grids, and of
// frames between them.

import { instantsBetween } from './between';
import { PlayerState, nearestTime, stopped, withTimes } from './player';

export class Timeline {
    player: PlayerState;
    stored: string[] = []; // times of the domain's grids
    private missing = new Set<string>(); // instants between them for which there is no frame

    // `betweenS`: seconds from one frame between volumes to the next; 0: there are none.
    constructor(
        follows: boolean,
        private betweenS: () => number,
    ) {
        this.player = { ...stopped, follows };
    }

    // The time that is to be shown.
    get now(): string | undefined {
        return this.player.times[this.player.at];
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
        this.player = withTimes(this.player, betweenS > 0 ? instantsBetween(stored, betweenS, this.missing) : stored);
    }
    // The time that is nearest to the wanted one. Returns false if it is another.
    find(wanted: string): boolean {
        this.player = { ...this.player, at: nearestTime(this.player.times, wanted) };
        return this.now === undefined || Date.parse(this.now) === Date.parse(wanted);
    }
    // Near the ends and in gaps there is no frame between volumes, and a loop may meet a grid that was evicted: the
    // time is left out. Returns false if it is not.
    leaveOut(time: string): boolean {
        const isBetween = this.isBetween(time);
        if (this.missing.has(time) || !(isBetween || this.player.isPlaying)) return false;
        this.missing.add(time);
        this.take(this.stored.filter(one => isBetween || one !== time));
        return true;
    }
}
