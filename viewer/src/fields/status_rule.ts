// Finds state and value of a place between cells of a grid, by the status rule of pictures
// (render/products/cell_mixer.h).
//
// The cells about a place give weights to the states. The place is
//   - not seen if this state weighs more than all other states together, or if nothing has weight;
//   - else range folded or ambiguous, whichever weighs more, if both together weigh more than values, and more than no
//     echo;
//   - else no echo if this state weighs more than values;
//   - else a value: the mean of the cells with values. Phases average on a circle. Velocities take the heaviest value,
//     because a grid does not say at which velocity they alias.

import { MomentFacts, momentFacts } from '../wire/moments';
import { CellState } from '../wire/packed_grid';

export type Mixing = MomentFacts['mixing'];

export const mixingOf = (moment: string): Mixing => momentFacts(moment).mixing;

const circle = 360;
const mostParts = 8;

export class Mixer {
    state: CellState = CellState.notSeen; // of the last result()
    value = 0;

    private weights = new Float64Array(CellState.ambiguous + 1); // by state
    private values = new Float64Array(mostParts);
    private shares = new Float64Array(mostParts);
    private count = 0;

    constructor(private mixing: Mixing) {}

    clear(): void {
        this.weights.fill(0);
        this.count = 0;
    }

    add(state: CellState, value: number, weight: number): void {
        if (!(weight > 0)) return;
        this.weights[state]! += weight;
        if (state !== CellState.value) return;
        this.values[this.count] = value;
        this.shares[this.count++] = weight;
    }

    // Puts the result into `state` and `value`.
    result(): void {
        const [notSeen, noEcho, folded, valued] = this.weights as unknown as [number, number, number, number];
        const ambiguous = this.weights[CellState.ambiguous]!;
        const unknown = folded + ambiguous;
        const seen = noEcho + unknown + valued;
        this.value = 0;
        if (notSeen > seen || seen === 0) this.state = CellState.notSeen;
        else if (unknown > valued && unknown > noEcho)
            this.state = folded >= ambiguous ? CellState.rangeFolded : CellState.ambiguous;
        else if (valued < noEcho) this.state = CellState.noEcho;
        else {
            this.state = CellState.value;
            this.value = this.mean();
        }
    }

    private mean(): number {
        let heaviest = 0;
        for (let i = 1; i < this.count; ++i) if (this.shares[i]! > this.shares[heaviest]!) heaviest = i;
        const reference = this.values[heaviest]!;
        if (this.mixing === 'heaviest') return reference;
        let [sum, weight] = [0, 0];
        for (let i = 0; i < this.count; ++i) {
            let off = this.values[i]! - reference;
            if (this.mixing === 'circle') off -= circle * Math.floor(off / circle + 0.5);
            sum += this.shares[i]! * off;
            weight += this.shares[i]!;
        }
        const mean = reference + sum / weight;
        return this.mixing === 'circle' ? mean - circle * Math.floor(mean / circle) : mean;
    }
}
