// Chooses the ranges of bricks to ask for, so that few requests fetch many columns.

export interface BrickRange {
    first: number;
    end: number; // number of the last brick plus 1
}

// Returns ranges of bricks that hold the columns, each of `layers` bricks. Columns share a range if the columns between
// them have at most `mostSkipped` bytes, and the range has at most `most` bytes and at most mostBricks bricks.
// `weightOf` returns the bytes of a column.
export function rangesOf(
    columns: readonly number[],
    layers: number,
    weightOf: (column: number) => number,
    mostSkipped: number,
    most: number,
): BrickRange[] {
    const ranges: BrickRange[] = [];
    let last: BrickRange | null = null;
    let weight = 0;
    for (const column of [...new Set(columns)].sort((one, other) => one - other)) {
        let between = 0;
        if (last)
            for (let skipped = last.end / layers; skipped < column && between <= mostSkipped; ++skipped)
                between += weightOf(skipped);
        const more = between + weightOf(column);
        if (
            last &&
            between <= mostSkipped &&
            weight + more <= most &&
            (column + 1) * layers - last.first <= mostBricks
        ) {
            last.end = (column + 1) * layers;
            weight += more;
        } else {
            last = { first: column * layers, end: (column + 1) * layers };
            weight = weightOf(column);
            ranges.push(last);
        }
    }
    return ranges;
}
const mostBricks = 16384; // the server refuses longer ranges
