// Plans the beam glyphs of a sweep of velocities: a line along the beam for the part of the wind that the radar
// measures, and a disc across the beam for the part that no beam measured. So no glyph is an arrow of the wind.
//
// render/map/beam_glyphs.h has the rules. Here the glyphs are on a lattice of the ground, so that they turn with the
// picture. The length of a line shows its speed, from wherever the camera looks.

import { Vec3, ViewGeometry } from '../camera/geometry';
import { GridPlane, Plane, destination, geodesic } from '../earth/projection';
import { DrawnSweep } from '../renderer/layer_passes';
import { gateAt } from '../scene/solid_hits';
import { CellState } from '../wire/packed_grid';
import { beamAt, rangeAt } from '../fields/sweep_cone';

export type Pixel = [number, number];

export interface BeamGlyph {
    gate: Pixel; // center of the disc
    tip: Pixel; // end of the line; the same pixel for a calm
    axes: [Pixel, Pixel]; // half axes of the disc
    value: number; // m/s away from the radar; negative: toward it
}

export const pixelsPerMps = 0.75;
export const discRadius = 5.2;
const calmMps = 1;
const leastTilt = 0.36; // a disc that is seen from its edge is drawn a little tilted
const latticePixels = 23; // lattices are one to two times as wide
const leastAcross = 0.12; // a beam that points at the camera cannot be seen
const stepM = 500;
const mostPoints = 20_000;
const radians = Math.PI / 180;

// Returns the columns and rows of lattice points on the ground of the picture.
function latticeOf(geometry: ViewGeometry, spacingM: number): { low: Pixel; high: Pixel } | null {
    const { width, height, box } = geometry;
    const corners = [0, 0.5, 1].flatMap((x) => [0, 0.5, 1].map((y) => geometry.ground(x * width, y * height)));
    const low: Pixel = [-box.halfXM, -box.halfYM];
    const high: Pixel = [box.halfXM, box.halfYM];
    // A picture with sky shows ground up to the horizon, so the box alone limits the lattice.
    if (corners.every((one): one is Plane => one !== null)) {
        for (const i of [0, 1] as const) {
            const all = corners.map((one) => one[i]);
            const margin = 0.1 * (Math.max(...all) - Math.min(...all)); // the cone is above the ground
            low[i] = Math.max(low[i], Math.min(...all) - margin);
            high[i] = Math.min(high[i], Math.max(...all) + margin);
        }
    }
    for (const i of [0, 1] as const) [low[i], high[i]] = [Math.ceil(low[i] / spacingM), Math.floor(high[i] / spacingM)];
    const count = (high[0] - low[0] + 1) * (high[1] - low[1] + 1);
    return count > 0 && count <= mostPoints ? { low, high } : null;
}

// The places that glyphs take.
class Taken {
    private cells = new Map<string, Pixel[]>();
    constructor(private apart: number) {}

    // Takes the places along a line if all are free.
    claim(from: Pixel, to: Pixel): boolean {
        const parts = 1 + Math.floor((2 * Math.hypot(to[0] - from[0], to[1] - from[1])) / this.apart);
        const places = [...Array(parts + 1).keys()].map((i): Pixel => [
            from[0] + ((to[0] - from[0]) * i) / parts,
            from[1] + ((to[1] - from[1]) * i) / parts,
        ]);
        if (!places.every((one) => this.isFree(one))) return false;
        for (const one of places) {
            const key = this.cellOf(one).join();
            this.cells.set(key, [...(this.cells.get(key) ?? []), one]);
        }
        return true;
    }
    private cellOf([x, y]: Pixel): Pixel {
        return [Math.floor(x / this.apart), Math.floor(y / this.apart)];
    }
    private isFree([x, y]: Pixel): boolean {
        const [column, row] = this.cellOf([x, y]);
        for (const dx of [-1, 0, 1])
            for (const dy of [-1, 0, 1])
                for (const other of this.cells.get([column + dx, row + dy].join()) ?? [])
                    if (Math.hypot(other[0] - x, other[1] - y) < this.apart) return false;
        return true;
    }
}

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// Returns the half axes of the disc across a beam. `beam` is the direction of the beam in drawn space, and `along` its
// direction in the picture.
function discAcross({ right, up }: ViewGeometry, beam: Vec3, along: Pixel, radius: number): [Pixel, Pixel] {
    const flat = Math.hypot(beam[0], beam[1]);
    const across: Vec3 = [beam[1] / flat, -beam[0] / flat, 0];
    const upright: Vec3 = [(-beam[0] * beam[2]) / flat, (-beam[1] * beam[2]) / flat, flat];
    const seen = (one: Vec3): Pixel => [radius * dot(one, right), -radius * dot(one, up)];
    const [a, b] = [seen(across), seen(upright)];
    // The area of the disc in the picture, as a share of a whole disc.
    const share = Math.abs(a[0] * b[1] - a[1] * b[0]) / (radius * radius);
    if (share >= leastTilt) return [a, b];
    return [
        [-radius * along[1], radius * along[0]],
        [radius * leastTilt * along[0], radius * leastTilt * along[1]],
    ];
}

// Plans the glyphs in pixels of the page, each of which is `ratio` pixels of the picture wide. Text is `scale` times as
// large as usual.
export function planGlyphs(
    geometry: ViewGeometry,
    { station, gates, radials }: DrawnSweep,
    plane: GridPlane,
    ratio: number,
    scale: number,
): BeamGlyph[] {
    const spacingM = 2 ** Math.ceil(Math.log2(latticePixels * scale * ratio * geometry.metersPerPixel));
    const lattice = latticeOf(geometry, spacingM);
    if (!lattice) return [];
    const radius = discRadius * scale;
    const taken = new Taken(2.2 * radius);
    const glyphs: BeamGlyph[] = [];
    const pixelAt = (azimuth: number, rangeM: number): { pixel: Pixel; drawn: Vec3 } | null => {
        const { arcM, heightM } = beamAt(gates, gates.elevationDeg, rangeM);
        const at = plane.toPlane(destination(gates, azimuth, arcM));
        const drawn: Vec3 | null = at && [at[0], at[1], heightM * geometry.exaggeration];
        const pixel = drawn && geometry.project(drawn);
        return drawn && pixel && { pixel: [pixel[0] / ratio, pixel[1] / ratio], drawn };
    };
    const [right, bottom] = [geometry.width / ratio, geometry.height / ratio];
    for (let row = lattice.low[1]; row <= lattice.high[1]; ++row) {
        for (let column = lattice.low[0]; column <= lattice.high[0]; ++column) {
            // Every other row is moved by half a step, which hides the rows.
            const at: Plane = [(column + (row % 2 === 0 ? 0 : 0.5)) * spacingM, row * spacingM];
            const { distanceM, azimuth } = geodesic(gates, plane.toPlace(at));
            const rangeM = rangeAt(gates, gates.elevationDeg, distanceM);
            const azimuthDeg = (azimuth / radians + 360) % 360;
            const hit = gateAt(gates, radials, {
                station,
                azimuthDeg,
                rangeM,
                elevationDeg: 0,
                depth: 0,
                at,
                heightM: 0,
            });
            if (hit?.state !== CellState.value) continue;
            const [here, farther] = [pixelAt(azimuth, rangeM), pixelAt(azimuth, rangeM + stepM)];
            if (!here || !farther) continue;
            const [x, y] = here.pixel;
            if (!(x > radius && y > radius && x < right - radius && y < bottom - radius)) continue;
            const beam = here.drawn.map((one, i) => farther.drawn[i]! - one) as Vec3;
            const [dx, dy] = [farther.pixel[0] - x, farther.pixel[1] - y];
            const [length, whole] = [Math.hypot(dx, dy), Math.sqrt(dot(beam, beam))];
            if (length * ratio * geometry.metersPerPixel < leastAcross * whole) continue;
            const along: Pixel = [dx / length, dy / length];
            const way = Math.abs(hit.value) < calmMps ? 0 : pixelsPerMps * scale * hit.value;
            const tip: Pixel = [x + way * along[0], y + way * along[1]];
            const unit = beam.map((one) => one / whole) as Vec3;
            if (taken.claim([x, y], tip))
                glyphs.push({
                    gate: [x, y],
                    tip,
                    axes: discAcross(geometry, unit, along, radius),
                    value: hit.value,
                });
        }
    }
    return glyphs;
}
