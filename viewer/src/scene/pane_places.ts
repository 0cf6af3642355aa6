// Divides a picture into panes of the same size.

import { PaneCount } from './panes';

// Place of a pane, in pixels from the upper left of the picture.
export interface PanePlace {
    left: number;
    top: number;
    width: number;
    height: number;
}

const leastSide = 16;

// Returns the places of the panes, with `gap` pixels between two panes. Two panes are side by side if the
// picture is wider than high, and otherwise
// one above the other. Four panes are two rows of two.
export function panePlaces(count: PaneCount, width: number, height: number, gap: number): PanePlace[] {
    const columns = count === 4 || (count === 2 && width >= height) ? 2 : 1;
    const rows = count / columns;
    const side = (all: number, of: number) => Math.max(leastSide, of === 1 ? all : Math.floor((all - gap) / 2));
    const [wide, high] = [side(width, columns), side(height, rows)];
    return Array.from({ length: count }, (_, i) => ({
        left: (i % columns) * (wide + gap),
        top: Math.floor(i / columns) * (high + gap),
        width: wide,
        height: high,
    }));
}

// Returns the index of the pane at a point; the nearest pane for a point between panes.
export function paneAt(places: readonly PanePlace[], x: number, y: number): number {
    const off = ({ left, top, width, height }: PanePlace) =>
        Math.hypot(Math.max(left - x, 0, x - left - width), Math.max(top - y, 0, y - top - height));
    return places.reduce((best, place, i) => (off(place) < off(places[best]!) ? i : best), 0);
}
