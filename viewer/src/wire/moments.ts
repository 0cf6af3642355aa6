// Moments by their names in answers of the server.

import { moments } from '../facts';

export interface MomentFacts {
    unit: string; // stored; '1' for a number without one
    mixing: 'mean' | 'heaviest' | 'circle'; // of cells, between their centers
    isDoppler: boolean;
}

export const isMoment = (name: string): name is keyof typeof moments =>
    Object.prototype.hasOwnProperty.call(moments, name);

// Throws an Error for any other name.
export function momentFacts(name: string): MomentFacts {
    if (!isMoment(name)) throw new Error(`${name}: no such moment`);
    return moments[name];
}
