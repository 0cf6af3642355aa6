// Defines the lines and points of files that others made, such as warnings. They are drawn over the picture
// (include/stormcellar/render/overlays.h).

import { Place } from '../earth/projection';

export type Rgb = readonly [number, number, number];

// A line or a point on the ground. The outline of an area is a line that ends where it begins.
export interface Shape {
    places: Place[]; // one place: a dot with a label
    color: Rgb | null; // null: the color of the map's text
    width: number; // in pixels
    label: string; // of a point
    fromMs: number; // in force from this time on
    untilMs: number; // and before this time
}

export interface Shapes {
    shapes: Shape[];
    unknown: number; // parts of the file that cannot be drawn, such as images
}

export const mostShapePlaces = 1_000_000;
export const mostFileBytes = 64 * 2 ** 20;

export const isInForce = ({ fromMs, untilMs }: Shape, timeMs: number): boolean => fromMs <= timeMs && timeMs < untilMs;

export function shapesInForce({ shapes }: Shapes, timeMs: number): Shape[] {
    return shapes.filter((shape) => isInForce(shape, timeMs));
}

// Returns how many of the shapes a picture of this time shows, in the words of `stormcellar frame`.
export function shownText(all: Shapes, timeMs: number): string {
    const unknown = all.unknown > 0 ? `, ${all.unknown} unknown` : '';
    return `${shapesInForce(all, timeMs).length} of ${all.shapes.length} in force${unknown}`;
}
