// Writes the view into the address of the page: at once, or now and then while something moves. Browsers take long to
// show an address, and some refuse to do it often.

import { ViewState, stateOf } from '../scene/view_state';
import { namesOf } from '../tables/units';
import { rememberedUnits } from './remembered';

const afterMs = 150; // less than leastStillAfterMs (drawing.ts), after which a resting view gets its fine picture
const everyMs = 1000; // while something moves

// Returns the view of an address. If the address names no units, takes the units that the user chose last.
export function stateOfAddress(hash = location.hash): ViewState {
    const state = stateOf(hash);
    return namesOf(state.units) ? state : { ...state, units: rememberedUnits() };
}

// Returns the time parameter of the address if it is neither a time nor `latest`, cut to 40 characters; otherwise an
// empty text.
export function timeThatIsNone(hash = location.hash): string {
    const time = new URLSearchParams(hash.slice(1)).get('time') ?? '';
    return time !== '' && time !== 'latest' && stateOf(hash).time === 'latest' ? time.slice(0, 40) : '';
}

// Returns true if the address says how to look at the echo.
export function namesView(hash = location.hash): boolean {
    const query = new URLSearchParams(hash.slice(1));
    const names = ['azimuth', 'tilt', 'zoom', 'field-of-view', 'look-at-km', 'exaggeration', 'opacity', 'view'];
    return names.some((name) => query.has(name));
}

export class AddressBar {
    private timer = 0;
    private writtenAt = 0;

    constructor(private address: () => string) {}

    writeSoon(): void {
        window.clearTimeout(this.timer);
        const isLate = performance.now() - this.writtenAt > everyMs;
        const { hash } = location;
        // Do not overwrite an address that the user types before the timer fires.
        this.timer = window.setTimeout(() => location.hash === hash && this.write(), isLate ? 0 : afterMs);
    }
    write(): void {
        this.drop();
        this.writtenAt = performance.now();
        history.replaceState(null, '', `#${this.address()}`);
    }
    // Cancels writeSoon().
    drop(): void {
        window.clearTimeout(this.timer);
    }
}
