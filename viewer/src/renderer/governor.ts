// Chooses a rung (a way of drawing; ladder.ts) for each frame, so that frames come in time while the camera moves. It
// chooses among the rungs whose error is allowed: the most exact rung that should be drawn in time, or the fastest rung
// if no rung should be.
//
// Divided by the cost of its rung, the time of a frame estimates how long the first rung would take. A moving mean of
// these estimates, times the cost of a rung, predicts the time of a frame on that rung.

import { Rung } from './ladder';

// Share of the allowed time that a more exact rung may need before the governor takes it. This keeps the picture from
// alternating between two rungs.
const margin = 0.8;
const weight = 0.5; // of the newest frame in the moving mean

export class Governor {
    private firstRungMs: number | null = null;
    private moving: Rung | null = null;

    constructor(
        private rungs: readonly Rung[],
        private targetMs: number,
        private mostDE: number,
    ) {}

    // Returns the rung for the next frame. This is the first rung if the view does not move, or if no rung is allowed.
    // Until a frame has been measured, this is the most exact allowed rung.
    next(isMoving: boolean): Rung {
        const still = this.rungs[0]!;
        if (!isMoving) {
            this.moving = null;
            return still;
        }
        // Do not spend more on a frame while the view moves than while it rests.
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

    // Returns how long a frame on this rung should take, in ms; null until a frame has been measured.
    predictedMs({ cost }: Rung): number | null {
        return this.firstRungMs === null ? null : cost * this.firstRungMs;
    }

    took(rung: Rung, ms: number): void {
        const unit = ms / rung.cost;
        this.firstRungMs = this.firstRungMs === null ? unit : this.firstRungMs + weight * (unit - this.firstRungMs);
    }
}
