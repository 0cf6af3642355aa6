// The units in which the page writes speeds, distances and heights (render/view/units.cpp has the same table).
// They change texts and the distances of rings, never what is drawn or stored: that is in meters and meters per
// second everywhere. Temperatures do not occur.

import { units as facts } from '../facts';

export interface Unit {
    name: string; // on the command line and in addresses
    symbol: string; // on the page
    si: number; // one of it in meters, or in meters per second
}

export type Quantity = keyof typeof facts;
export type Units = Record<Quantity, Unit>;

// The usual one comes first.
export const knownUnits: Record<Quantity, readonly [Unit, ...Unit[]]> = facts;
export const quantities = Object.keys(knownUnits) as Quantity[];

export const usualUnits: Units = {
    speed: knownUnits.speed[0],
    distance: knownUnits.distance[0],
    height: knownUnits.height[0],
};

// Reads "knots,miles,kft", in any order. A quantity without a name that makes sense has its usual unit.
export function unitsOf(names: string): Units {
    const given = names.split(',');
    const chosen = (quantity: Quantity) =>
        knownUnits[quantity].find((unit) => given.includes(unit.name)) ?? usualUnits[quantity];
    return { speed: chosen('speed'), distance: chosen('distance'), height: chosen('height') };
}

// Names the units that are not the usual ones, as unitsOf() and `stormcellar frame --units` read them.
export function namesOf(units: Units): string {
    return quantities
        .filter((quantity) => units[quantity].name !== usualUnits[quantity].name)
        .map((quantity) => units[quantity].name)
        .join(',');
}

// Rounds feet to hundreds, and other units to tenths.
function rounded(meters: number, { name, si }: Unit): string {
    return name === 'feet' ? String(100 * Math.round(meters / si / 100)) : (meters / si).toFixed(1);
}

// Returns a height as a number without its unit.
export function heightNumber(meters: number, units: Units): string {
    return rounded(meters, units.height);
}
export function heightText(meters: number, units: Units): string {
    return `${heightNumber(meters, units)} ${units.height.symbol}`;
}
export function distanceText(meters: number, units: Units): string {
    return `${rounded(meters, units.distance)} ${units.distance.symbol}`;
}

export interface ShownUnit {
    symbol: string; // empty for a number without a unit
    perStored: number; // shown = stored * perStored
}

// Returns the unit to write for values that are stored in the unit of a moment: the chosen unit for speeds,
// else the stored one.
export function shownUnit(stored: string, units: Units): ShownUnit {
    if (stored === usualUnits.speed.symbol) return { symbol: units.speed.symbol, perStored: 1 / units.speed.si };
    return { symbol: stored === '1' ? '' : stored, perStored: 1 };
}

// Writes a value of a moment with its unit, with as many digits as its stored form has, at most `digits`.
export function valueText(value: number, stored: string, units: Units, digits = 2): string {
    const { symbol, perStored } = shownUnit(stored, units);
    const number = Number((value * perStored).toFixed(perStored === 1 ? digits : 1));
    return symbol === '' ? String(number) : `${number} ${symbol}`;
}

// Returns the distance between rings, so that about three fit into `halfM`.
export function ringSpacingM(halfM: number, units: Units): number {
    const wanted = (halfM / 3) * 0.7;
    const steps = [10, 25, 50, 100, 200, 500, 1000].map((number) => number * units.distance.si);
    return steps.find((step) => step >= wanted) ?? steps[steps.length - 1]!;
}
