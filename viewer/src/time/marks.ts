// Chooses the marks for which a timeline has room.

// Times that share a mark, as indexes; both are included.
export interface Run {
    from: number;
    to: number;
}

// Returns the times in runs of equal length, of which there are at most `most`. The last run may be shorter.
export function runsOf(count: number, most: number): Run[] {
    const length = Math.max(1, Math.ceil(count / most));
    return Array.from({ length: Math.ceil(count / length) }, (_, i) => ({
        from: i * length,
        to: Math.min(count, (i + 1) * length) - 1,
    }));
}

// Returns the indexes of the times that get a label, rising. There are at most `most`, at equal steps, and the last
// time is among them.
export function labeledOf(count: number, most: number): number[] {
    const step = most < 2 ? Math.max(1, count) : Math.max(1, Math.ceil((count - 1) / (most - 1)));
    const found: number[] = [];
    for (let index = count - 1; index >= 0; index -= step) found.unshift(index);
    return found;
}

// Returns the place of a time on the slider as a share of its length; 0 for a single time.
export const shareOf = (index: number, count: number): number =>
    count < 2 ? 0 : Math.min(1, Math.max(0, index / (count - 1)));
