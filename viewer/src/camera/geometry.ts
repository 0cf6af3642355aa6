// Computes where points of a grid are in the picture, with the same camera as `stormcellar frame`
// (include/stormcellar/render/view_geometry.h).
//
// Drawn space has x to the east and y to the north, in meters from the middle of the grid. Its z is the height above
// sea level in meters, times the exaggeration. Pixel (0, 0) is the top left corner.

export type Vec3 = [number, number, number];

export interface Camera {
    azimuthDeg: number; // direction from the scene to the camera; 180 looks from the south
    tiltDeg: number; // from the vertical: 0 looks straight down, 90 along the ground
    zoom: number; // 1: the whole grid fits into the picture
    fieldOfViewDeg: number; // across the picture at zoom 1; 0: orthographic
    lookAtM: Vec3 | null; // east, north, and height above sea level; null: the middle of the box
}

export const usualCamera: Camera = { azimuthDeg: 180, tiltDeg: 55, zoom: 1, fieldOfViewDeg: 0, lookAtM: null };

// The box of a grid's cells, in meters, not exaggerated.
export interface Box {
    halfXM: number;
    halfYM: number;
    bottomM: number;
    topM: number;
}

const margin = 1.04;
const nearestShare = 1e-4;
const flattest = 1e-6;
const singleLevelM = 1000;

export function heightRange(levelsM: ArrayLike<number>): { bottomM: number; topM: number } {
    const last = levelsM.length - 1;
    const first = levelsM[0]!;
    if (last === 0) return { bottomM: first - singleLevelM / 2, topM: first + singleLevelM / 2 };
    return {
        bottomM: first - (levelsM[1]! - first) / 2,
        topM: levelsM[last]! + (levelsM[last]! - levelsM[last - 1]!) / 2,
    };
}

export function dot(a: Vec3, b: Vec3): number {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
export function minus(a: Vec3, b: Vec3): Vec3 {
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}
// a + s b
export function plus(a: Vec3, s: number, b: Vec3): Vec3 {
    return [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
}

export class ViewGeometry {
    readonly right: Vec3;
    readonly up: Vec3;
    readonly forward: Vec3;
    readonly eye: Vec3; // point of depth 0: the camera in perspective, else the middle of the box
    readonly middle: Vec3;
    readonly focalPixels: number; // 0: orthographic
    readonly metersPerPixel: number; // at the middle of the box
    readonly nearM: number;
    readonly farM: number;
    readonly groundM: number;

    constructor(
        readonly box: Box,
        camera: Camera,
        readonly exaggeration: number,
        readonly width: number,
        readonly height: number,
    ) {
        const radians = Math.PI / 180;
        const [sa, ca] = [Math.sin(camera.azimuthDeg * radians), Math.cos(camera.azimuthDeg * radians)];
        const [st, ct] = [Math.sin(camera.tiltDeg * radians), Math.cos(camera.tiltDeg * radians)];
        this.forward = [-st * sa, -st * ca, -ct];
        this.right = [-ca, sa, 0];
        this.up = [-ct * sa, -ct * ca, st];
        this.groundM = Math.min(0, box.bottomM);
        this.middle = [0, 0, 0.5 * (this.groundM + box.topM) * exaggeration];
        let eye = this.middle;
        if (camera.fieldOfViewDeg > 0) {
            const focal = (0.5 * width) / Math.tan(0.5 * camera.fieldOfViewDeg * radians);
            this.focalPixels = focal * camera.zoom;
            eye = plus(this.middle, -this.distanceBack(focal), this.forward);
            const toMiddle = dot(minus(this.middle, eye), this.forward);
            this.metersPerPixel = Math.max(toMiddle, box.halfXM * 1e-3) / this.focalPixels;
        } else {
            this.focalPixels = 0;
            this.metersPerPixel = this.fittedScale() / camera.zoom;
        }
        if (camera.lookAtM) {
            const drawn: Vec3 = [camera.lookAtM[0], camera.lookAtM[1], camera.lookAtM[2] * exaggeration];
            eye = plus(eye, 1, minus(drawn, this.middle));
        }
        this.eye = eye;
        [this.nearM, this.farM] = this.depths();
    }

    get isPerspective(): boolean {
        return this.focalPixels > 0;
    }

    // Returns true for a view from straight above, without perspective.
    get isMap(): boolean {
        return !this.isPerspective && this.forward[2] < -1 + flattest;
    }

    private corners(lowM: number): Vec3[] {
        const all: Vec3[] = [];
        for (let i = 0; i < 8; ++i) {
            all.push([
                (i & 1) !== 0 ? this.box.halfXM : -this.box.halfXM,
                (i & 2) !== 0 ? this.box.halfYM : -this.box.halfYM,
                ((i & 4) !== 0 ? this.box.topM : lowM) * this.exaggeration,
            ]);
        }
        return all;
    }

    private fittedScale(): number {
        let across = 0;
        let upright = 0;
        for (const corner of this.corners(this.groundM)) {
            const from = minus(corner, this.middle);
            across = Math.max(across, Math.abs(dot(from, this.right)));
            upright = Math.max(upright, Math.abs(dot(from, this.up)));
        }
        return margin * Math.max((2 * across) / this.width, (2 * upright) / this.height);
    }

    private distanceBack(focal: number): number {
        let back = 0;
        for (const corner of this.corners(this.groundM)) {
            const from = minus(corner, this.middle);
            const aside = Math.abs(dot(from, this.right)) / (0.5 * this.width);
            const upright = Math.abs(dot(from, this.up)) / (0.5 * this.height);
            back = Math.max(back, margin * focal * Math.max(aside, upright) - dot(from, this.forward));
        }
        return back;
    }

    private depths(): [number, number] {
        let near = Infinity;
        let far = -Infinity;
        for (const corner of this.corners(this.box.bottomM)) {
            const depth = dot(minus(corner, this.eye), this.forward);
            near = Math.min(near, depth);
            far = Math.max(far, depth);
        }
        if (!this.isPerspective) return [near, far];
        const nearest = nearestShare * Math.max(Math.abs(near), Math.abs(far));
        near = Math.max(near, nearest);
        return [near, Math.max(far, near + nearest)];
    }

    // Returns the least and the greatest depth of the visible part of the box. Over the picture, the depth at which
    // rays meet a level plane is least and greatest in corners, so only the corners are examined.
    get shownDepths(): [number, number] {
        const corners: [number, number][] = [
            [0, 0],
            [this.width, 0],
            [0, this.height],
            [this.width, this.height],
        ];
        const depthsAt = (heightM: number, beyond: number) =>
            corners.map(([x, y]) => {
                const step = this.along(x, y)[2];
                const depth = (heightM * this.exaggeration - this.point(x, y, 0)[2]) / step;
                return step < -flattest && (depth > 0 || !this.isPerspective) ? depth : beyond;
            });
        const near = Math.max(this.nearM, Math.min(...depthsAt(this.box.topM, this.nearM)));
        const far = Math.min(this.farM, Math.max(...depthsAt(this.box.bottomM, this.farM)));
        return near < far ? [near, far] : [this.nearM, this.farM];
    }

    // Returns how far ahead of the camera a point of drawn space is.
    depthOf(drawn: Vec3): number {
        return dot(minus(drawn, this.eye), this.forward);
    }

    // Returns the pixel of a point of drawn space; null behind a perspective camera.
    project(drawn: Vec3): [number, number] | null {
        const p = minus(drawn, this.eye);
        let scale = 1 / this.metersPerPixel;
        if (this.isPerspective) {
            const depth = dot(p, this.forward);
            if (!(depth > 0)) return null;
            scale = this.focalPixels / depth;
        }
        return [0.5 * this.width + dot(p, this.right) * scale, 0.5 * this.height - dot(p, this.up) * scale];
    }

    // Returns the vector by which a pixel's ray moves for each meter of depth.
    along(x: number, y: number): Vec3 {
        if (!this.isPerspective) return this.forward;
        const a = (x - 0.5 * this.width) / this.focalPixels;
        const b = (0.5 * this.height - y) / this.focalPixels;
        return plus(plus(this.forward, a, this.right), b, this.up);
    }

    point(x: number, y: number, depthM: number): Vec3 {
        const direction = this.along(x, y);
        const a = this.isPerspective ? 0 : (x - 0.5 * this.width) * this.metersPerPixel;
        const b = this.isPerspective ? 0 : (0.5 * this.height - y) * this.metersPerPixel;
        return plus(plus(plus(this.eye, a, this.right), b, this.up), depthM, direction);
    }

    // Returns the ground under a pixel, in meters from the middle; null in the sky.
    ground(x: number, y: number): [number, number] | null {
        const start = this.point(x, y, 0);
        const step = this.along(x, y);
        if (!(step[2] < -flattest)) return null;
        const depth = -(start[2] - this.groundM * this.exaggeration) / step[2];
        if (this.isPerspective && !(depth > 0)) return null;
        return [start[0] + depth * step[0], start[1] + depth * step[1]];
    }
}
