// Finds the kept grids that are outdated after one was made again.
//
// Their keys are DOMAIN/MOMENT/TIME, and times are rising texts of ISO 8601.

import { longestBridgeMs } from './between';

// Returns a test that is true for old keys: the grid of `of` (DOMAIN/MOMENT) at the time, frames between it
// and its neighbors among `times` (without times: as far as frames are made), and regions, which are merged of
// it. The region that is shown (`shown`) is left out, because the page knows which of its instants are new.
export function outdatedBy(of: string, time: string, times: string[], shown: string): (key: string) => boolean {
    const far = (ms: number) => (times.length > 0 ? time : new Date(Date.parse(time) + ms).toISOString());
    const before = times.filter((one) => one < time).pop() ?? far(-longestBridgeMs);
    const after = times.find((one) => one > time) ?? far(longestBridgeMs);
    return (key) => {
        const at = key.slice(of.length + 1);
        if (key.startsWith(`${of}/`)) return at === time || (at > before && at < after);
        return key.startsWith('region:') && !key.startsWith(`${shown}/`);
    };
}
