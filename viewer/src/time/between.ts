// Lists instants between volumes, for which the server makes grids on request (docs/web/grids.md).

export const longestBridgeMs = 30 * 60 * 1000; // as in pipeline/mosaic/between_grids.h

// Returns the stored times, and between them the whole multiples of `everyS` seconds. Gaps that are too long stay
// empty. Leaves out the instants in `missing`, for which the server had no grid.
export function instantsBetween(stored: string[], everyS: number, missing: ReadonlySet<string>): string[] {
    const everyMs = everyS * 1000;
    const instants: string[] = stored.slice(0, 1);
    for (let i = 1; i < stored.length; instants.push(stored[i++]!)) {
        const [from, to] = [Date.parse(stored[i - 1]!), Date.parse(stored[i]!)];
        if (to - from > longestBridgeMs) continue;
        for (let at = Math.ceil(from / everyMs) * everyMs; at < to; at += everyMs) {
            const instant = new Date(at).toISOString().replace('.000Z', 'Z');
            if (at > from && !missing.has(instant)) instants.push(instant);
        }
    }
    return instants;
}
