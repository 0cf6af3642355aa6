// Lists the ways of drawing (rungs), with their costs and their differences from the slicer. scripts/viewer-ladder
// measures and writes the rows below.
//
// dE is the difference from the slicer with 2048 slices, in CIEDE2000. A row has the 99th percentile over the pixels
// that show echo in either picture, in the scene with the largest difference.

export interface Quality {
    name: string;
    slices: number;
    grain: number; // each ray covers grain x grain pixels
    isNearest: boolean; // cells are not interpolated
    halvings: number; // level of the finest bricks that are drawn
}

export interface Rung extends Quality {
    cost: number; // time of a frame, relative to the first rung
    dE: number;
}

// The first rung draws a view at rest.
export const rungs: readonly Rung[] = [
    { name: '256 slices', slices: 256, grain: 1, isNearest: false, halvings: 0, cost: 1.0, dE: 8.6 },
    { name: '512 slices', slices: 512, grain: 1, isNearest: false, halvings: 0, cost: 1.61, dE: 3.2 },
    { name: '128 slices', slices: 128, grain: 1, isNearest: false, halvings: 0, cost: 0.62, dE: 19.9 },
    { name: '64 slices', slices: 64, grain: 1, isNearest: false, halvings: 0, cost: 0.44, dE: 33.4 },
    { name: '256 slices, half resolution', slices: 256, grain: 2, isNearest: false, halvings: 0, cost: 0.4, dE: 9.9 },
    { name: '128 slices, half resolution', slices: 128, grain: 2, isNearest: false, halvings: 0, cost: 0.31, dE: 17.6 },
    { name: '64 slices, half resolution', slices: 64, grain: 2, isNearest: false, halvings: 0, cost: 0.25, dE: 31.9 },
    { name: 'nearest cell', slices: 256, grain: 1, isNearest: true, halvings: 0, cost: 0.82, dE: 21.2 },
    { name: 'halved bricks', slices: 256, grain: 1, isNearest: false, halvings: 1, cost: 2.05, dE: 45.0 },
];

// Rungs that can draw any grid. Only a grid in parts has halved bricks.
export const usualRungs = rungs.filter(({ halvings }) => halvings === 0);
