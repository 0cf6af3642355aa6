// Which of the grids that the page keeps are old once one was made again.
//
// Their keys are DOMAIN/MOMENT/TIME, and times are rising texts of ISO 8601.

// Old are the grid of `of` (DOMAIN/MOMENT) at the time, frames between it and its neighbors among `times`, and regions,
// which are merged of it. Of the region that is shown (`shown`) the page knows which of its instants are new.
export function outdatedBy(of: string, time: string, times: string[], shown: string): (key: string) => boolean {
    const [before, after] = [times.filter(one => one < time).pop() ?? time, times.find(one => one > time) ?? time];
    return key => {
        const at = key.slice(of.length + 1);
        if (key.startsWith(`${of}/`)) return at === time || (at > before && at < after);
        return key.startsWith('region:') && !key.startsWith(`${shown}/`);
    };
}
