// The units in which the page writes speeds, distances and heights, as render/view/units.cpp has them
// for pictures. They change texts and the distances of rings, never what is drawn or stored: that is in
// meters and meters per second everywhere. Temperatures do not occur.

export interface Unit {
    name: string; // on the command line and in addresses
    symbol: string; // on the page
    si: number; // one of it in meters, or in meters per second
    digits: number; // behind the point, of a height or a distance
}

const foot = 0.3048;
const mile = 5280 * foot;
const nauticalMile = 1852;

export type Quantity = 'speed' | 'distance' | 'height';
export type Units = Record<Quantity, Unit>;

// The usual one comes first.
export const knownUnits: Record<Quantity, readonly [Unit, ...Unit[]]> = {
    speed: [
        { name: 'm/s', symbol: 'm/s', si: 1, digits: 1 },
        { name: 'knots', symbol: 'kt', si: nauticalMile / 3600, digits: 1 },
        { name: 'mph', symbol: 'mph', si: mile / 3600, digits: 1 },
        { name: 'km/h', symbol: 'km/h', si: 1 / 3.6, digits: 1 },
    ],
    distance: [
        { name: 'km', symbol: 'km', si: 1000, digits: 1 },
        { name: 'miles', symbol: 'mi', si: mile, digits: 1 },
        { name: 'nautical-miles', symbol: 'nmi', si: nauticalMile, digits: 1 },
    ],
    height: [
        { name: 'km', symbol: 'km', si: 1000, digits: 1 },
        { name: 'kft', symbol: 'kft', si: 1000 * foot, digits: 1 },
        { name: 'feet', symbol: 'ft', si: foot, digits: -2 },
    ],
};
export const quantities = Object.keys(knownUnits) as Quantity[];

export const usualUnits: Units = { speed: knownUnits.speed[0], distance: knownUnits.distance[0], height: knownUnits.height[0] };

// Reads "knots,miles,kft", in any order. A quantity without a name that makes sense has its usual unit.
export function unitsOf(names: string): Units {
    const given = names.split(',');
    const chosen = (quantity: Quantity) => knownUnits[quantity].find(unit => given.includes(unit.name)) ?? usualUnits[quantity];
    return { speed: chosen('speed'), distance: chosen('distance'), height: chosen('height') };
}

// The units that are not the usual ones, as unitsOf() and `stormcellar frame --units` read them.
export function namesOf(units: Units): string {
    return quantities
        .filter(quantity => units[quantity].name !== usualUnits[quantity].name)
        .map(quantity => units[quantity].name)
        .join(',');
}

function rounded(value: number, digits: number): string {
    const power = 10 ** digits;
    return digits >= 0 ? value.toFixed(digits) : String(Math.round(value * power) / power);
}

// A height as a number without its unit.
export function heightNumber(meters: number, units: Units): string {
    return rounded(meters / units.height.si, units.height.digits);
}
export function heightText(meters: number, units: Units): string {
    return `${heightNumber(meters, units)} ${units.height.symbol}`;
}
export function distanceText(meters: number, units: Units): string {
    return `${rounded(meters / units.distance.si, units.distance.digits)} ${units.distance.symbol}`;
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

// A value of a moment with its unit; as many digits as its stored form has, at most `digits`.
export function valueText(value: number, stored: string, units: Units, digits = 2): string {
    const { symbol, perStored } = shownUnit(stored, units);
    const number = Number((value * perStored).toFixed(perStored === 1 ? digits : 1));
    return symbol === '' ? String(number) : `${number} ${symbol}`;
}

// Returns the distance between rings, so that about three fit into `halfM`.
export function ringSpacingM(halfM: number, units: Units): number {
    const wanted = (halfM / 3) * 0.7;
    const steps = [10, 25, 50, 100, 200, 500, 1000].map(number => number * units.distance.si);
    return steps.find(step => step >= wanted) ?? steps[steps.length - 1]!;
}
