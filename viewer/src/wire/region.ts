// The names of regions: "region:west,south,east,north", in degrees.

const side = String.raw`-?\d{1,3}(\.\d+)?`;
const pattern = new RegExp(`^region:(${side},){3}${side}$`);

// Returns true for exactly four numbers, because the name goes into requests and commands as it is.
export const isRegion = (domain: string): boolean => pattern.test(domain);

export function regionName({
    west,
    south,
    east,
    north,
}: {
    west: number;
    south: number;
    east: number;
    north: number;
}): string {
    return `region:${[west, south, east, north].map((degrees) => Number(degrees.toFixed(3))).join(',')}`;
}

// Returns the four numbers of a name, as the server takes them.
export function sidesOf(domain: string): string {
    return domain.replace(/^region:/, '');
}
