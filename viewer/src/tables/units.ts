// Writes speeds, distances and heights in the units that the user chose (render/view/units.cpp has the same table).
// Units change texts, marks of axes and the distances of rings. All data are in meters and meters per second. The page
// has no temperatures.

import { units as facts } from '../facts';

export interface Unit {
    name: string; // on the command line and in addresses
    symbol: string; // on the page
    si: number; // length of one unit in meters, or its speed in meters per second
}

export type Quantity = keyof typeof facts;
export type Units = Record<Quantity, Unit>;

// Units by quantity, the usual unit first.
export const knownUnits: Record<Quantity, readonly [Unit, ...Unit[]]> = facts;
export const quantities = Object.keys(knownUnits) as Quantity[];

export const usualUnits: Units = {
    speed: knownUnits.speed[0],
    distance: knownUnits.distance[0],
    height: knownUnits.height[0],
};

// Reads names of units in any order, as "knots,miles,kft". A quantity without a known name has its usual unit.
export function unitsOf(names: string): Units {
    const given = names.split(',');
    const chosen = (quantity: Quantity) =>
        knownUnits[quantity].find((unit) => given.includes(unit.name)) ?? usualUnits[quantity];
    return { speed: chosen('speed'), distance: chosen('distance'), height: chosen('height') };
}

// Returns the names of the units that are not usual, as unitsOf() and `stormcellar frame --units` read them.
export function namesOf(units: Units): string {
    return quantities
        .filter((quantity) => units[quantity].name !== usualUnits[quantity].name)
        .map((quantity) => units[quantity].name)
        .join(',');
}

// Returns a length as text, rounded to hundreds of feet or to tenths of another unit.
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
    perStored: number; // factor from a stored value to the shown value
}

// Returns the unit in which to write values that are stored in the unit `stored`. This is the chosen unit for speeds,
// and the stored unit for all other quantities.
export function shownUnit(stored: string, units: Units): ShownUnit {
    if (stored === usualUnits.speed.symbol) return { symbol: units.speed.symbol, perStored: 1 / units.speed.si };
    return { symbol: stored === '1' ? '' : stored, perStored: 1 };
}

// Returns a value with its unit as text. A converted value has at most one decimal, and any other value has at most
// `digits`.
export function valueText(value: number, stored: string, units: Units, digits = 2): string {
    const { symbol, perStored } = shownUnit(stored, units);
    const number = Number((value * perStored).toFixed(perStored === 1 ? digits : 1));
    return symbol === '' ? String(number) : `${number} ${symbol}`;
}

// Returns the distance between rings. It is the least round number of units that is at least 7/30 of `halfM`, so at
// most four rings fit into `halfM`. It is at most 1000 units, even if more rings fit then.
export function ringSpacingM(halfM: number, units: Units): number {
    const wanted = (halfM / 3) * 0.7;
    const steps = [10, 25, 50, 100, 200, 500, 1000].map((number) => number * units.distance.si);
    return steps.find((step) => step >= wanted) ?? steps[steps.length - 1]!;
}
