// Chooses the ranges of bricks to ask for, so that few requests fetch many columns.

export interface BrickRange {
    first: number;
    end: number; // behind the last
}

// Returns the ranges of columns of `layers` bricks each. One range has columns that follow each other or that have
// little between them: by the bytes of a column, `weightOf`, it skips at most `mostSkipped` in a row and holds at most
// `most`.
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
// The server refuses more.
const mostBricks = 16384;
