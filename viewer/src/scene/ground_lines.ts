// Projects lines and cities of the map onto the plane of a grid.

import { ViewGeometry } from '../camera/geometry';
import { mapKinds } from '../facts';
import { Units, ringSpacingM } from '../tables/units';
import { City, MapAnswer, MapKind, MapLine } from '../wire/api';
import { Site } from '../wire/packed_grid';
import { GridPlane, Plane } from '../earth/projection';

export interface MapLines {
    kind: MapKind | 'ring' | 'border';
    segments: Float32Array; // x, y, x, y in meters from the middle
}

export interface Mark {
    kind: 'city' | 'site' | 'ring';
    text: string;
    at: Plane;
    rank: number; // marks of greater rank are drawn first
}

// Lines farther than this many half widths of the grid are not drawn.
const reach = 2.2;
// Ranks of marks. Distances of rings rank above cities, and sites rank above both.
const ringRank = 1e8;
const siteRank = 1e9;

function segmentsOf(
    lines: (Plane | null)[][],
    halfM: number,
    isDrawn: (line: number, point: number) => boolean = () => true,
): Float32Array {
    const ends: number[] = [];
    const isNear = (p: Plane) => Math.abs(p[0]) < reach * halfM && Math.abs(p[1]) < reach * halfM;
    lines.forEach((line, number) => {
        for (let i = 1; i < line.length; ++i) {
            const [a, b] = [line[i - 1], line[i]];
            if (a && b && (isNear(a) || isNear(b)) && isDrawn(number, i)) ends.push(a[0], a[1], b[0], b[1]);
        }
    });
    return new Float32Array(ends);
}

// A line of the map, and its points on a plane. A point is null if the projection cannot show it.
export interface ProjectedLine {
    line: MapLine;
    points: (Plane | null)[];
}
export function projected(map: MapAnswer, plane: GridPlane): ProjectedLine[] {
    return map.lines.map((line) => ({
        line,
        points: line.points.map(([longitudeDeg, latitudeDeg]) => plane.toPlane({ latitudeDeg, longitudeDeg })),
    }));
}

// The map cuts areas along the edges of tiles of 2 by 2 degrees. These cuts are not drawn, because they are not coasts.
const tileDeg = 2;
export function isCut({ is_area, points }: MapLine, point: number): boolean {
    const [from, to] = [points[point - 1]!, points[point]!];
    return is_area && [0, 1].some((axis) => from[axis] === to[axis] && from[axis]! % tileDeg === 0);
}
export function withoutCuts(line: MapLine): [number, number][][] {
    const pieces: [number, number][][] = [];
    let piece: [number, number][] = [];
    line.points.forEach((point, i) => {
        if (i > 0 && isCut(line, i)) {
            pieces.push(piece);
            piece = [];
        }
        piece.push(point);
    });
    pieces.push(piece);
    return pieces.filter((one) => one.length > 1);
}

// Returns how many meters of ground a pixel covers in the finest part of the picture.
function finestMetersPerPixel(geometry: ViewGeometry): number {
    const x = 0.5 * geometry.width;
    const widths = [0.5, 0.75, 1].map((share) => {
        const [left, right] = [x - 1, x + 1].map((at) => geometry.ground(at, share * geometry.height));
        return left && right ? Math.hypot(right[0] - left[0], right[1] - left[1]) / 2 : Infinity;
    });
    const finest = Math.min(...widths);
    return finest > 0 && Number.isFinite(finest) ? finest : geometry.metersPerPixel;
}

// Returns the kinds of lines that are not too dense in this view. Each pixel of the view is `grain` pixels wide.
export function shownKinds(geometry: ViewGeometry, grain: number): Set<MapLines['kind']> {
    const finestM = finestMetersPerPixel(geometry) / grain;
    const isShown = ({ usualM, leastPixels }: { usualM: number; leastPixels: number }) =>
        usualM >= leastPixels * finestM;
    const kinds = Object.entries(mapKinds).filter(([, facts]) => isShown(facts));
    return new Set([...kinds.map(([kind]) => kind as MapKind), 'ring', 'border']);
}

export function mapLines(all: ProjectedLine[], halfM: number): MapLines[] {
    return (Object.keys(mapKinds) as MapKind[]).map((kind) => {
        const own = all.filter(({ line }) => line.kind === kind);
        const isDrawn = (number: number, point: number) => !isCut(own[number]!.line, point);
        return {
            kind,
            segments: segmentsOf(
                own.map(({ points }) => points),
                halfM,
                isDrawn,
            ),
        };
    });
}

// Returns the border of the grid, rings about the site if there is just one, and marks of rings and sites.
export function ringLines(
    sites: Site[],
    plane: GridPlane,
    halfX: number,
    halfY: number,
    units: Units,
): { lines: MapLines[]; marks: Mark[] } {
    const border: Plane[] = [
        [-halfX, -halfY],
        [halfX, -halfY],
        [halfX, halfY],
        [-halfX, halfY],
        [-halfX, -halfY],
    ];
    const lines: MapLines[] = [{ kind: 'border', segments: segmentsOf([border], Math.max(halfX, halfY)) }];
    const marks: Mark[] = [];
    if (sites.length === 1) {
        const center = plane.toPlane(sites[0]!);
        const spacing = ringSpacingM(Math.max(halfX, halfY), units);
        const rings: Plane[][] = [];
        for (let r = spacing; center && r < Math.hypot(halfX, halfY); r += spacing) {
            const points: Plane[] = [];
            for (let i = 0; i <= 180; ++i) {
                const angle = (i * Math.PI) / 90;
                points.push([center[0] + r * Math.sin(angle), center[1] + r * Math.cos(angle)]);
            }
            rings.push(points);
            if (r < Math.max(halfX, halfY))
                marks.push({
                    kind: 'ring',
                    text: `${Math.round(r / units.distance.si)} ${units.distance.symbol}`,
                    at: [center[0], center[1] + r],
                    rank: ringRank,
                });
        }
        lines.unshift({ kind: 'ring', segments: segmentsOf(rings, Math.max(halfX, halfY)) });
    }
    for (const site of sites) {
        const at = plane.toPlane(site);
        if (at) marks.push({ kind: 'site', text: site.icao, at, rank: siteRank });
    }
    return { lines, marks };
}

export function cityMarks(cities: City[], plane: GridPlane, halfX: number, halfY: number): Mark[] {
    const marks: Mark[] = [];
    for (const city of cities) {
        const at = plane.toPlane({ latitudeDeg: city.place[1], longitudeDeg: city.place[0] });
        if (at && Math.abs(at[0]) < 1.3 * halfX && Math.abs(at[1]) < 1.3 * halfY)
            marks.push({ kind: 'city', text: city.name, at, rank: city.population });
    }
    return marks;
}
