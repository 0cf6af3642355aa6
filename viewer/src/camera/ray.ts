// Computes places along the ray through a pixel, by their depth ahead of the camera (see ViewGeometry).

import { Vec3, ViewGeometry } from './geometry';

export class Ray {
    readonly start: Vec3; // place at depth 0, in drawn space
    readonly way: Vec3; // how far the ray moves for each meter of depth

    constructor(
        readonly geometry: ViewGeometry,
        x: number,
        y: number,
    ) {
        this.start = geometry.point(x, y, 0);
        this.way = geometry.along(x, y);
    }

    // Returns the place in meters from the middle of the grid.
    at(depth: number): [number, number] {
        return [this.start[0] + depth * this.way[0], this.start[1] + depth * this.way[1]];
    }
    // Returns the height above sea level.
    heightM(depth: number): number {
        return (this.start[2] + depth * this.way[2]) / this.geometry.exaggeration;
    }
    // Returns the depth at which the ray passes a height; not finite for a level ray.
    depthAt(heightM: number): number {
        return (heightM * this.geometry.exaggeration - this.start[2]) / this.way[2];
    }
}
