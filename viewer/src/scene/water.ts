// Finds land and lakes as rings on the plane of a grid. All other ground is sea.
//
// Coasts and lakes of the map are rings that are cut along meridians and parallels (render/map/base_map.h). A cut is
// straight in degrees, but not on the plane. Long cuts are divided at the same places on both sides, so that no gap
// opens between two tiles.

import { ProjectedLine, isCut } from './ground_lines';
import { GridPlane, Plane } from '../earth/projection';

const longestCutDeg = 0.25;

// Returns places along a cut at multiples of the longest allowed step, without the ends of the cut.
function betweenOf(
    [longitudeA, latitudeA]: [number, number],
    [longitudeB, latitudeB]: [number, number],
): [number, number][] {
    const isUpright = longitudeA === longitudeB;
    const [from, to] = (isUpright ? [latitudeA, latitudeB] : [longitudeA, longitudeB]).map(
        (degrees) => degrees / longestCutDeg,
    ) as [number, number];
    const places: [number, number][] = [];
    const step = Math.sign(to - from);
    for (let part = step > 0 ? Math.floor(from) + 1 : Math.ceil(from) - 1; step * part < step * to; part += step) {
        places.push(isUpright ? [longitudeA, part * longestCutDeg] : [part * longestCutDeg, latitudeA]);
    }
    return places;
}

function ringOf({ line, points }: ProjectedLine, plane: GridPlane): Plane[] {
    return points.flatMap((point, i) => {
        const between = i > 0 && isCut(line, i) ? betweenOf(line.points[i - 1]!, line.points[i]!) : [];
        const places = between.map(([longitudeDeg, latitudeDeg]) => plane.toPlane({ latitudeDeg, longitudeDeg }));
        return [...places, point].filter((one): one is Plane => one !== null);
    });
}

// Returns the rings of land (`kind` is 'coast') or of lakes.
export function ringsOf(all: ProjectedLine[], kind: 'coast' | 'lake', plane: GridPlane): Plane[][] {
    return all.filter(({ line }) => line.is_area && line.kind === kind).map((one) => ringOf(one, plane));
}
