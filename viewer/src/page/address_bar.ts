// Writes the view into the address of the page: at once, or now and then while something moves. Browsers take long to
// show an address, and some refuse to do it often.

import { ViewState, stateOf } from '../scene/view_state';
import { namesOf } from '../tables/units';
import { rememberedUnits } from './remembered';

const afterMs = 150; // less than the picture waits until it is fine
const everyMs = 1000; // while something moves

// Returns the view of an address. If it names no units, takes those that the user had last.
export function stateOfAddress(hash = location.hash): ViewState {
    const state = stateOf(hash);
    return namesOf(state.units) ? state : { ...state, units: rememberedUnits() };
}

// Returns the text that stands for the time but is none; empty if the address has a time, or none at all.
export function timeThatIsNone(hash = location.hash): string {
    const time = new URLSearchParams(hash.slice(1)).get('time') ?? '';
    return time !== '' && time !== 'latest' && stateOf(hash).time === 'latest' ? time.slice(0, 40) : '';
}

export class AddressBar {
    private timer = 0;
    private writtenAt = 0;

    constructor(private address: () => string) {}

    writeSoon(): void {
        window.clearTimeout(this.timer);
        const isLate = performance.now() - this.writtenAt > everyMs;
        const { hash } = location;
        // Keep an address that was typed meanwhile.
        this.timer = window.setTimeout(() => location.hash === hash && this.write(), isLate ? 0 : afterMs);
    }
    write(): void {
        this.drop();
        this.writtenAt = performance.now();
        history.replaceState(null, '', `#${this.address()}`);
    }
    // Drops an address that waits to be written.
    drop(): void {
        window.clearTimeout(this.timer);
    }
}
