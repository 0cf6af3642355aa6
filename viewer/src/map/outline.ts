// Finds the border of a grid on the earth.

import { Place, Plane, cellSizeM, destination, planeOf, projectionNamed } from '../earth/projection';
import { GridFacts } from '../wire/api';
import { GridPlace } from '../wire/packed_grid';

const pointsOfASide = 16;
const pointsOfACircle = 72;

export function placeOfFacts(facts: GridFacts): GridPlace {
    return {
        projection: projectionNamed(facts.projection),
        centerDeg: facts.center,
        parallelsDeg: facts.parallels_deg ?? [0, 0],
        offsetCells: facts.offset_cells,
        spacing: facts.spacing_m ?? facts.spacing_deg ?? 1,
        nx: facts.nx,
        ny: facts.ny,
    };
}

function halvesM(facts: GridFacts): [number, number] {
    const [width, height] = cellSizeM(placeOfFacts(facts));
    return [(facts.nx * width) / 2, (facts.ny * height) / 2];
}

// Returns points along the border of a grid. Each side has several points, because a side is usually curved on another
// map.
export function outlineOf(facts: GridFacts): Place[] {
    const plane = planeOf(placeOfFacts(facts));
    const [x, y] = halvesM(facts);
    const corners: Plane[] = [
        [-x, -y],
        [x, -y],
        [x, y],
        [-x, y],
    ];
    return corners.flatMap((from, i) => {
        const to = corners[(i + 1) % 4]!;
        return Array.from({ length: pointsOfASide }, (_, k) => {
            const share = k / pointsOfASide;
            return plane.toPlace([from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]);
        });
    });
}

// Returns points of the largest circle about the center that fits into a radar's own grid.
export function circleOf(facts: GridFacts): Place[] {
    const center: Place = { latitudeDeg: facts.center[0], longitudeDeg: facts.center[1] };
    const radiusM = Math.min(...halvesM(facts));
    return Array.from({ length: pointsOfACircle }, (_, i) =>
        destination(center, (2 * Math.PI * i) / pointsOfACircle, radiusM),
    );
}
