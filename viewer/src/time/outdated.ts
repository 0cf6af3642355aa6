// Finds the kept grids that are outdated after the server made a grid again. Keys of grids are DOMAIN/MOMENT/TIME;
// times are ISO 8601.

import { longestBridgeMs } from './between';

// Returns a function that is true for the keys of outdated grids. `of` (DOMAIN/MOMENT) and `time` name the grid that
// was made again. These grids are outdated:
//   - the kept grid of this time;
//   - frames between this time and its neighbors in `times`, which rise; if `times` is empty, frames within
//     longestBridgeMs;
//   - regions, which may be merged from this grid. Only the region `shown` (DOMAIN/MOMENT) is kept, because the page
//     knows which of its instants changed.
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
