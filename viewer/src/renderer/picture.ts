// A picture as a generator of its parts. Between parts the page acts, and the graphics processor draws. So no task of
// the page is long, and a picture can be given up.

import { PanePlace } from '../scene/pane_places';
import { Frame } from './frame';

// One frame that fills the canvas, or several panes. A pane without a frame stays empty.
export interface Picture {
    width: number;
    height: number;
    panes: readonly { frame: Frame | null; place: PanePlace }[];
}

// Yields after each part. next() takes the time that the part took, in ms.
export type Parts = Generator<void, void, number>;

const partMs = 90; // wanted time of a part
const firstRows = 128;
const leastRows = 8;

// Returns the rows of the next strip, after a strip of `rows` rows took `ms`.
export function nextRows(rows: number, ms: number): number {
    const wanted = (rows * partMs) / Math.max(1, ms);
    return Math.max(leastRows, Math.round(Math.min(2 * rows, wanted)));
}

// Draws a frame in horizontal strips, from the bottom to the top. `draw` draws the rows from `from` to `to`.
export function* inStrips(height: number, draw: (from: number, to: number) => void): Parts {
    for (let from = 0, rows = firstRows; from < height;) {
        const to = Math.min(height, from + rows);
        draw(from, to);
        rows = nextRows(rows, yield);
        from = to;
    }
}

// Draws all parts. `drawn` resolves when the graphics processor has drawn a part. Before each further part, gives up if
// `isStopped` returns true, and then returns false.
export async function drawParts(parts: Parts, drawn: () => Promise<void>, isStopped: () => boolean): Promise<boolean> {
    for (let ms = 0; !parts.next(ms).done;) {
        const begun = performance.now();
        await drawn();
        ms = performance.now() - begun;
        if (isStopped()) return false;
    }
    return true;
}
