// Instants between volumes, for which the server makes grids when it is asked (docs/web/grids.md).

const longestBridgeMs = 30 * 60 * 1000; // as pipeline/mosaic/between_grids.h has it
export const usualBetweenS = 60;

// Whole multiples of `everyS` seconds between neighbors of `stored`, and the newest stored time. In longer
// gaps nothing is made. `missing` are instants for which the server had no grid.
export function instantsBetween(stored: string[], everyS: number, missing: ReadonlySet<string>): string[] {
    const newest = stored[stored.length - 1];
    if (newest === undefined) return [];
    const everyMs = everyS * 1000;
    const instants: string[] = [];
    for (let i = 1; i < stored.length; ++i) {
        const [from, to] = [Date.parse(stored[i - 1]!), Date.parse(stored[i]!)];
        if (to - from > longestBridgeMs) continue;
        for (let at = Math.ceil(from / everyMs) * everyMs; at < to; at += everyMs) {
            const instant = new Date(at).toISOString().replace('.000Z', 'Z');
            if (at > from && !missing.has(instant)) instants.push(instant);
        }
    }
    return [...instants, newest];
}
