// Finds what is under a pixel of the picture: what is seen most of all that is drawn there.

import { boundsAbout } from '../atlas/window_choice';
import { ViewGeometry } from '../camera/geometry';
import { croppedBox, Crop } from '../scene/layers';
import { firstVisible, mostVisible, wayWithin } from '../scene/first_visible';
import { Cells, boxOf } from '../scene/grid_box';
import { Place, Plane, planeOf } from '../earth/projection';
import { GateHit, SolidHit, levelHit, sectionHit, sweepHit } from '../scene/solid_hits';
import { colorOf, extinctionPerM } from '../tables/color_table';
import { CellState, codeAt, firstValueCode, valueOf } from '../wire/packed_grid';
import { App } from './app';
import { Drawing } from './drawing';
import { columnAt } from './reading';

export type PickedLayer = 'volume' | 'plane' | 'section' | 'surface' | 'maximum' | 'sweep' | 'ground' | 'outside';

export interface Picked {
    layer: PickedLayer;
    at: Plane;
    place: Place;
    heightM: number;
    state: CellState | null; // of the ground it is that of the lowest cell above it; null: not known here
    value: number; // where the state is a value
    gate: GateHit | null; // of a sweep
    halvings: number; // how often the cells were halved that were read: 0 if they are the grid's own
    lacksCells: boolean; // until the cells along the ray have come, something else may be seen there, or at another height
}

const leastSeen = 0.03; // of a pixel, by the volume before the ground
const leastVeil = 0.1; // of the greatest height of the box, through range folded air

interface Met {
    layer: PickedLayer;
    hit: SolidHit;
    isSolid: boolean; // hides what is behind
}

// Returns the hits of layers along the ray, the nearest first; those that are solid hide what is behind.
function solidsAt(
    app: App,
    drawing: Drawing,
    geometry: ViewGeometry,
    cells: Cells | null,
    whole: Crop,
    x: number,
    y: number,
): Met[] {
    const { drawn } = drawing;
    const { shown, shownTable: table, state } = app;
    if (!drawn || !shown || !table) return [];
    const plane = planeOf(shown.loaded.grid);
    const isShown = ({ state: status, value }: SolidHit) =>
        status === CellState.rangeFolded ||
        (status === CellState.value && value >= (state.least ?? -Infinity) && colorOf(table, value) !== null);
    const met: Met[] = [];
    const add = (layer: PickedLayer, hit: SolidHit | null) => {
        if (hit) met.push({ layer, hit, isSolid: isShown(hit) });
    };
    if (drawn.plane) add('plane', levelHit(geometry, drawn.plane, drawn.plane.heightM, x, y, drawn.mixes));
    if (drawn.section) add('section', sectionHit(geometry, drawn.section, x, y, drawn.mixes));
    if (drawn.sweep) add('sweep', sweepHit(geometry, drawn.sweep, plane, x, y, isShown));
    if (drawn.maximum) add('maximum', levelHit(geometry, drawn.maximum, geometry.groundM, x, y, drawn.mixes));
    if (drawn.surface) {
        const { value, isBelow, of } = drawn.surface;
        const own = of ? { grid: of.grid, middle: [0, 0] as Plane } : cells;
        const seen =
            own &&
            firstVisible(own, geometry, croppedBox(whole, drawn.crop), x, y, (one) =>
                isBelow ? one <= value : one >= value,
            );
        // The moment that is shown colors it.
        const colored =
            seen &&
            (of && cells ? cellAt(cells, seen.at, seen.heightM) : { state: CellState.value, value: seen.value });
        if (seen && colored) {
            const depth = depthOf(geometry, seen.at, seen.heightM);
            met.push({ layer: 'surface', hit: { ...seen, ...colored, depth }, isSolid: true });
        }
    }
    return met.sort((a, b) => a.hit.depth - b.hit.depth);
}

const depthOf = (geometry: ViewGeometry, [x, y]: Plane, heightM: number): number =>
    geometry.depthOf([x, y, heightM * geometry.exaggeration]);

// Reads the cell at a place, on the lowest level that is not below the height; null beyond the grid.
function cellAt({ grid, middle }: Cells, [x, y]: Plane, heightM: number): { state: CellState; value: number } | null {
    const column = columnAt(grid, x - middle[0], y - middle[1]);
    const level = grid.levelsM.findIndex((one) => one >= heightM);
    if (!column || level < 0) return null;
    const code = codeAt(grid, ...column, level);
    return { state: Math.min(code, CellState.value), value: code >= firstValueCode ? valueOf(grid, code) : 0 };
}

// The height of the greatest value of a column, which the column maximum shows.
function heightOfMaximum({ grid, middle }: Cells, [x, y]: Plane): number | null {
    const column = columnAt(grid, x - middle[0], y - middle[1]);
    if (!column) return null;
    let [best, code] = [-1, 0];
    for (let z = 0; z < grid.nz; ++z) {
        const one = codeAt(grid, ...column, z);
        if (one > code) [best, code] = [z, one];
    }
    return code >= firstValueCode ? grid.levelsM[best]! : null;
}

// Returns what a pixel shows; null if that is the sky. Asks for the cells of a grid in parts along the ray if
// `asks`; until they have come, leaves out the volume and the surface.
export function pick(app: App, drawing: Drawing, left: number, top: number, asks: boolean): Picked | null {
    const [x, y] = [left + 0.5, top + 0.5]; // the middle of the pixel, as it is drawn
    const geometry = drawing.geometry();
    const { shown, shownTable: table, state } = app;
    if (!geometry || !shown || !table) return null;
    const { grid, stream } = shown.loaded;
    const plane = planeOf(grid);
    const { halfXM, halfYM, bottomM, topM } = boxOf(grid);
    const whole: Crop = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
    const box = croppedBox(whole, state.layers.crop);
    const ground = geometry.ground(x, y);
    const points = [...(wayWithin(geometry, box, x, y) ?? []), ...(ground ? [ground] : [])];
    const isAlong = boundsAbout(points, grid) !== null; // it meets columns of the grid
    const cells = isAlong && (asks || !stream) ? drawing.windows.ray(shown.loaded, points) : null;
    const isThrough = state.layers.hasVolume || drawing.drawn?.surface != null;
    const picked = (
        layer: PickedLayer,
        at: Plane,
        heightM: number,
        status: CellState | null,
        value = 0,
        gate: GateHit | null = null,
    ): Picked => ({
        layer,
        at,
        place: plane.toPlace(at),
        heightM,
        state: status,
        value,
        gate,
        lacksCells:
            !cells && isAlong && layer !== 'outside' && (isThrough || layer === 'maximum' || layer === 'ground'),
        // Some layers are read as they are drawn, the others along the ray.
        halvings:
            layer === 'sweep'
                ? 0
                : drawing.windows.halvings(
                      shown.loaded,
                      layer === 'section' ? layer : layer === 'plane' || layer === 'maximum' ? 'layers' : 'ray',
                  ),
    });
    const met = solidsAt(app, drawing, geometry, cells, whole, x, y);
    const solid = met.find((one) => one.isSolid) ?? null;
    // The volume, until something solid or the ground hides it.
    const untilDepth = Math.min(
        solid?.hit.depth ?? Infinity,
        ground ? depthOf(geometry, ground, geometry.groundM) : Infinity,
    );
    const perM = (value: number) =>
        value >= (state.least ?? -Infinity) ? extinctionPerM(table, value, state.opacity) : 0;
    const volume = state.layers.hasVolume && cells ? mostVisible(cells, geometry, box, x, y, untilDepth, perM) : null;
    if (volume?.cell && (solid ? volume.share > volume.through : 1 - volume.through > leastSeen))
        return picked('volume', volume.cell.at, volume.cell.heightM, CellState.value, volume.cell.value);
    const nearest = solid ?? met[0];
    if (nearest) {
        const { layer, hit } = nearest;
        const heightM = layer === 'maximum' && cells ? heightOfMaximum(cells, hit.at) : hit.heightM;
        return picked(
            layer,
            hit.at,
            heightM ?? hit.heightM,
            hit.state,
            hit.value,
            layer === 'sweep' ? (hit as GateHit) : null,
        );
    }
    if (!ground) return null;
    if (!columnAt(grid, ...ground)) return picked('outside', ground, geometry.groundM, null);
    if (volume && drawing.drawn?.hasFolded && volume.foldedM > leastVeil * (topM - bottomM) * geometry.exaggeration) {
        return picked('volume', ground, geometry.groundM, CellState.rangeFolded);
    }
    const column = cells && columnAt(cells.grid, ground[0] - cells.middle[0], ground[1] - cells.middle[1]);
    if (!column) return picked('ground', ground, geometry.groundM, null);
    const code = codeAt(cells.grid, ...column, 0);
    return picked(
        'ground',
        ground,
        geometry.groundM,
        Math.min(code, CellState.value),
        code >= firstValueCode ? valueOf(cells.grid, code) : 0,
    );
}
