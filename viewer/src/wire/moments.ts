// Finds facts of moments by their names in answers of the server.

import { momentTitles, moments } from '../facts';

export interface MomentFacts {
    unit: string; // unit of stored values; '1' for a number without a unit
    mixing: 'mean' | 'heaviest' | 'circle'; // how to combine cells between their centers (fields/status_rule.ts)
    isSigned: boolean; // values on both sides of zero are equally strong
    isDoppler: boolean;
    isDerived: boolean; // no radar sends the moment; cells and gates may be ambiguous
    measured: string; // the moment from which a derived moment comes, or the moment itself
}

export const isMoment = (name: string): name is keyof typeof moments =>
    Object.prototype.hasOwnProperty.call(moments, name);

// Returns the facts of a moment. Throws an Error for an unknown name.
export function momentFacts(name: string): MomentFacts {
    if (!isMoment(name)) throw new Error(`${name}: no such moment`);
    return moments[name];
}

// Returns true if the moment with a number in packed grids and sweeps is derived. Moments that the page does not know
// are not.
export const isDerivedNumber = (number: number): boolean => Object.values(moments)[number]?.isDerived ?? false;

// Returns the measured moment from which a moment comes. The two share tables of colors.
export const measuredOf = (name: string): string => (isMoment(name) ? moments[name].measured : name);

// Returns the moment that is derived from a measured moment; null if there is none.
export function derivedOf(name: string): string | null {
    const found = Object.entries(moments).find(([, { isDerived, measured }]) => isDerived && measured === name);
    return found ? found[0] : null;
}

// Returns the title of a moment, or the name of a moment that the page does not know.
export const titleOf = (name: string): string => (isMoment(name) ? momentTitles[name] : name);

// Returns the moments in the order of their buttons: a derived moment follows its measured moment, even if the server
// has no grids of it.
export function momentsInOrder(there: string[]): { moment: string; isThere: boolean }[] {
    const isAlone = (moment: string) => !there.includes(measuredOf(moment));
    return there
        .filter((moment) => measuredOf(moment) === moment || isAlone(moment))
        .flatMap((moment) => [moment, derivedOf(moment)])
        .filter((moment): moment is string => moment !== null)
        .map((moment) => ({ moment, isThere: there.includes(moment) }));
}
