// Finds facts of moments by their names in answers of the server.

import { moments } from '../facts';

export interface MomentFacts {
    unit: string; // unit of stored values; '1' for a number without a unit
    mixing: 'mean' | 'heaviest' | 'circle'; // how to combine cells between their centers (fields/status_rule.ts)
    isDoppler: boolean;
}

export const isMoment = (name: string): name is keyof typeof moments =>
    Object.prototype.hasOwnProperty.call(moments, name);

// Returns the facts of a moment. Throws an Error for an unknown name.
export function momentFacts(name: string): MomentFacts {
    if (!isMoment(name)) throw new Error(`${name}: no such moment`);
    return moments[name];
}
