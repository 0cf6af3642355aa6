// Finds facts of moments by their names in answers of the server.

import { momentTitles, moments } from '../facts';

export interface MomentFacts {
    unit: string; // unit of stored values; '1' for a number without a unit
    mixing: 'mean' | 'heaviest' | 'circle'; // how to combine cells between their centers (fields/status_rule.ts)
    isSigned: boolean; // values on both sides of zero are equally strong
    isDoppler: boolean;
    isDerived: boolean; // no radar sends the moment; cells and gates may be ambiguous
    measured: string; // the moment from which a derived moment comes, or the moment itself
    tables: string; // the moment whose tables of colors the moment has
}

// Facts that most moments share. The table `moments` has the facts in which a moment differs.
const usual = { mixing: 'mean', isSigned: false, isDoppler: false, isDerived: false };
const facts = Object.fromEntries(
    Object.entries(moments).map(([name, own]) => [name, { ...usual, measured: name, tables: name, ...own }]),
) as Record<keyof typeof moments, MomentFacts>;

export const isMoment = (name: string): name is keyof typeof moments =>
    Object.prototype.hasOwnProperty.call(moments, name);

// Returns the facts of a moment. Throws an Error for an unknown name.
export function momentFacts(name: string): MomentFacts {
    if (!isMoment(name)) throw new Error(`${name}: no such moment`);
    return facts[name];
}

// Returns true for velocities along the beam, which have beam glyphs.
export function isVelocity(name: string): boolean {
    const facts = isMoment(name) ? momentFacts(name) : null;
    return facts !== null && facts.isSigned && facts.unit === 'm/s';
}

// Returns true if the moment with this number (in packed grids and sweeps) is derived; false for a moment that the page
// does not know.
export const isDerivedNumber = (number: number): boolean => Object.values(facts)[number]?.isDerived ?? false;

// Returns the measured moment from which a moment comes.
export const measuredOf = (name: string): string => (isMoment(name) ? facts[name].measured : name);

// Returns the moment whose tables of colors a moment has, as VELD has those of VEL.
export const tablesOf = (name: string): string => (isMoment(name) ? facts[name].tables : name);

// Returns the moment that shows the values of a measured moment dealiased; null if there is none.
export function derivedOf(name: string): string | null {
    const found = Object.entries(facts).find(
        ([, { isDerived, isDoppler, measured }]) => isDerived && isDoppler && measured === name,
    );
    return found ? found[0] : null;
}

// Returns the title of a moment, or the name of a moment that the page does not know.
export const titleOf = (name: string): string => (isMoment(name) ? momentTitles[name] : name);

// Returns the moments in the order of their buttons: VELD follows VEL, even if the server has no grids of VELD.
export function momentsInOrder(there: string[]): { moment: string; isThere: boolean }[] {
    const followsOther = (moment: string) =>
        derivedOf(measuredOf(moment)) === moment && there.includes(measuredOf(moment));
    return there
        .filter((moment) => !followsOther(moment))
        .flatMap((moment) => [moment, derivedOf(moment)])
        .filter((moment): moment is string => moment !== null)
        .map((moment) => ({ moment, isThere: there.includes(moment) }));
}
