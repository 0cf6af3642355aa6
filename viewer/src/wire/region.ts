// Reads and writes names of regions: "region:west,south,east,north", in degrees.

const side = String.raw`-?\d{1,3}(\.\d+)?`;
const pattern = new RegExp(`^region:(${side},){3}${side}$`);

// Returns true for a name with exactly four numbers. Other text must not pass, because names go into requests and
// commands unchanged.
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

// Returns the text after "region:", which has the four numbers separated by commas.
export function sidesOf(domain: string): string {
    return domain.replace(/^region:/, '');
}
