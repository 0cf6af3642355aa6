// Keeps the user's units in the browser from one visit to the next, if the browser permits storage.

import { Units, namesOf, unitsOf } from '../tables/units';

const unitsKey = 'stormcellar-units';

export function rememberUnits(units: Units): void {
    try {
        localStorage.setItem(unitsKey, namesOf(units));
    } catch {
        // Do without storage if the browser forbids it.
    }
}

export function rememberedUnits(): Units {
    try {
        return unitsOf(localStorage.getItem(unitsKey) ?? '');
    } catch {
        return unitsOf('');
    }
}
