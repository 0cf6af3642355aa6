// Keeps frames in time while the camera moves: takes the most exact rung with an allowed error that is expected to be
// drawn in time, else the fastest.
//
// The time of a frame is expected from the frames before: by the costs of the ladder, each tells how long the first
// rung would have taken.

import { Rung } from './ladder';

// A more exact rung is taken when it is expected to need this share of the time, so that the picture
// does not go to and fro between two rungs.
const margin = 0.8;
// Weight of the newest frame in the time of the first rung.
const weight = 0.5;

export class Governor {
    private firstRungMs: number | null = null;
    private moving: Rung | null = null;

    constructor(
        private rungs: readonly Rung[],
        private targetMs: number,
        private mostDE: number,
    ) {}

    // Returns the rung of the next frame: the first one if the picture stands still.
    next(isMoving: boolean): Rung {
        const still = this.rungs[0]!;
        if (!isMoving) {
            this.moving = null;
            return still;
        }
        // Nothing that moves is drawn with more effort than what stands still.
        const allowed = this.rungs
            .filter((rung) => rung.dE <= this.mostDE && rung.cost <= still.cost)
            .sort((one, other) => one.dE - other.dE);
        if (allowed.length === 0) return still;
        const unit = this.firstRungMs;
        if (unit === null) return allowed[0]!;
        const now = this.moving;
        const fits = (rung: Rung) => rung.cost * unit <= this.targetMs * (now && rung.dE < now.dE ? margin : 1);
        const fastest = allowed.reduce((one, other) => (other.cost < one.cost ? other : one));
        this.moving = allowed.find(fits) ?? fastest;
        return this.moving;
    }

    took(rung: Rung, ms: number): void {
        const unit = ms / rung.cost;
        this.firstRungMs = this.firstRungMs === null ? unit : this.firstRungMs + weight * (unit - this.firstRungMs);
    }

    // Call for another grid or view, of which the times before tell nothing.
    forget(): void {
        this.firstRungMs = null;
    }
}
