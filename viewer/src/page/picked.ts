// Finds the layer that a pixel of the picture mostly shows, and reads it.

import { boundsAbout } from '../atlas/window_choice';
import { Vec3, ViewGeometry } from '../camera/geometry';
import { Ray } from '../camera/ray';
import { croppedBox, Crop } from '../scene/layers';
import { firstVisible, mostVisible, wayWithin } from '../scene/first_visible';
import { Cells } from '../scene/grid_box';
import { Place, Plane, planeOf } from '../earth/projection';
import { GateHit, SolidHit, levelHit, sectionHit, sweepHit } from '../scene/solid_hits';
import { colorOf, extinctionPerM } from '../tables/color_table';
import { ColorTable } from '../wire/color_tables';
import { CellState, PackedGrid, codeAt, stateOf, valueOf } from '../wire/packed_grid';
import { Drawing } from './drawing';
import { wholeBox } from './layer_tools';
import { columnAt } from './column_reading';
import { Pane } from './pane';

export type PickedLayer = 'volume' | 'plane' | 'section' | 'surface' | 'maximum' | 'sweep' | 'ground' | 'outside';

export interface Picked {
    layer: PickedLayer;
    at: Plane;
    place: Place;
    heightM: number;
    state: CellState | null; // for the ground, the state of the lowest cell above it; null if unknown
    value: number; // 0 unless the state is a value
    gate: GateHit | null; // gate of a sweep; null for other layers
    halvings: number; // number of halvings of the cells that were read
    lacksCells: boolean; // cells along the ray have not come; they may change the layer or the height
}

const leastSeen = 0.03; // least share of a pixel for which the volume counts as seen before the ground
const leastVeil = 0.1; // least length in range folded air that counts as seen, as a share of the box's height

interface Met {
    layer: PickedLayer;
    hit: SolidHit;
    isSolid: boolean; // hides what is behind
}

// The ray through a pixel, and what the ray may meet.
interface Sight {
    ray: Ray;
    grid: PackedGrid; // the shown grid
    table: ColorTable;
    cells: Cells | null; // cells along the ray; null if they are not here
    whole: Crop; // the box of the grid
    ground: Plane | null; // where the ray meets the ground
}

// Returns where the ray meets layers, the nearest first. A hit that is solid hides what is behind it.
function solidsOn({ ray, grid, table, cells, whole }: Sight, { state, drawn }: Pane): Met[] {
    if (!drawn) return [];
    const { geometry } = ray;
    const isShown = ({ state: status, value }: SolidHit) =>
        status === CellState.rangeFolded ||
        status === CellState.ambiguous ||
        (status === CellState.value && value >= (state.least ?? -Infinity) && colorOf(table, value) !== null);
    const met: Met[] = [];
    const add = (layer: PickedLayer, hit: SolidHit | null) => {
        if (hit) met.push({ layer, hit, isSolid: isShown(hit) });
    };
    if (drawn.plane) add('plane', levelHit(ray, drawn.plane, drawn.plane.heightM, drawn.mixes));
    if (drawn.section) add('section', sectionHit(ray, drawn.section, drawn.mixes));
    if (drawn.sweep) add('sweep', sweepHit(ray, drawn.sweep, planeOf(grid), isShown));
    if (drawn.maximum) add('maximum', levelHit(ray, drawn.maximum, geometry.groundM, drawn.mixes));
    if (drawn.surface) {
        const { value, isBelow, of } = drawn.surface;
        const own = of ? { grid: of.grid, middle: [0, 0] as Plane } : cells;
        const seen =
            own &&
            firstVisible(own, ray, croppedBox(whole, drawn.crop), (one) => (isBelow ? one <= value : one >= value));
        // Read the value of the shown moment, which colors the surface.
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

// Reads the cell of a column on the lowest level that is at or above a height; null beyond the grid.
function cellAt({ grid, middle }: Cells, [x, y]: Plane, heightM: number): { state: CellState; value: number } | null {
    const column = columnAt(grid, x - middle[0], y - middle[1]);
    const level = grid.levelsM.findIndex((one) => one >= heightM);
    if (!column || level < 0) return null;
    const code = codeAt(grid, ...column, level);
    return { state: stateOf(grid, code), value: code >= grid.firstCode ? valueOf(grid, code) : 0 };
}

// Returns the height of the greatest value of a column; null without values.
function heightOfMaximum({ grid, middle }: Cells, [x, y]: Plane): number | null {
    const column = columnAt(grid, x - middle[0], y - middle[1]);
    if (!column) return null;
    let [best, code] = [-1, 0];
    for (let z = 0; z < grid.nz; ++z) {
        const one = codeAt(grid, ...column, z);
        if (one > code) [best, code] = [z, one];
    }
    return code >= grid.firstCode ? grid.levelsM[best]! : null;
}

type Found = Pick<Picked, 'layer' | 'at' | 'heightM' | 'state' | 'value' | 'gate'>;

const found = (
    layer: PickedLayer,
    at: Plane,
    heightM: number,
    state: CellState | null,
    value = 0,
    gate: GateHit | null = null,
): Found => ({ layer, at, heightM, state, value, gate });

// Returns what the ray mostly shows: the volume, a layer, or the ground; null for the sky.
function foundOn(sight: Sight, pane: Pane): Found | null {
    const { ray, table, cells, whole, ground } = sight;
    const { geometry } = ray;
    const { opacity, least, layers } = pane.state;
    const met = solidsOn(sight, pane);
    const solid = met.find((one) => one.isSolid) ?? null;
    // Read the volume up to the depth at which a solid layer or the ground hides it.
    const untilDepth = Math.min(
        solid?.hit.depth ?? Infinity,
        ground ? depthOf(geometry, ground, geometry.groundM) : Infinity,
    );
    const perM = (value: number) => (value >= (least ?? -Infinity) ? extinctionPerM(table, value, opacity) : 0);
    const volume =
        layers.hasVolume && cells ? mostVisible(cells, ray, croppedBox(whole, layers.crop), untilDepth, perM) : null;
    if (volume?.cell && (solid ? volume.share > volume.through : 1 - volume.through > leastSeen))
        return found('volume', volume.cell.at, volume.cell.heightM, CellState.value, volume.cell.value);
    const nearest = solid ?? met[0];
    if (nearest) {
        const { layer, hit } = nearest;
        const heightM = layer === 'maximum' && cells ? heightOfMaximum(cells, hit.at) : null;
        const gate = layer === 'sweep' ? (hit as GateHit) : null;
        return found(layer, hit.at, heightM ?? hit.heightM, hit.state, hit.value, gate);
    }
    return ground && groundOn(sight, ground, pane.drawn?.hasFolded ? (volume?.foldedM ?? 0) : 0);
}

// Returns what the ray shows at a place of the ground. Within the grid, this is range folded air if the ray's length in
// such air (`foldedM`) is great enough, and otherwise the ground.
function groundOn({ ray, grid, cells, whole }: Sight, ground: Plane, foldedM: number): Found {
    const { groundM, exaggeration } = ray.geometry;
    if (!columnAt(grid, ...ground)) return found('outside', ground, groundM, null);
    if (foldedM > leastVeil * (whole.topM - whole.bottomM) * exaggeration)
        return found('volume', ground, groundM, CellState.rangeFolded);
    const lowest = cells && cellAt(cells, ground, -Infinity);
    return found('ground', ground, groundM, lowest?.state ?? null, lowest?.value);
}

// Returns true if a section or a surface hides a place on the ground. The surface of a grid in parts hides nothing.
export function isHidden(pane: Pane, geometry: ViewGeometry, at: Plane): boolean {
    const { shown, shownTable: table, drawn } = pane;
    const whole = wholeBox(pane);
    if (!shown || !table || !whole || !(drawn?.section ?? drawn?.surface)) return false;
    const point: Vec3 = [...at, geometry.groundM * geometry.exaggeration];
    const pixel = geometry.project(point);
    if (!pixel) return false;
    const { grid, stream } = shown.loaded;
    const cells = stream ? null : pane.windows.ray(shown.loaded, [at]);
    const met = solidsOn({ ray: new Ray(geometry, ...pixel), grid, table, cells, whole, ground: at }, pane);
    const hides = ({ layer, hit, isSolid }: Met) =>
        isSolid && (layer === 'section' || layer === 'surface') && hit.depth < geometry.depthOf(point);
    return met.some(hides);
}

// Returns what a pixel of a pane, usually of the active one, shows; null for the sky, or if nothing is shown. For a
// grid in parts, asks for the cells along the ray if `asks` is true. Until these have come, leaves out the volume and
// the surface.
export function pick(drawing: Drawing, left: number, top: number, asks: boolean, pane = drawing.pane): Picked | null {
    const [x, y] = [left + 0.5, top + 0.5]; // middle of the pixel
    const geometry = drawing.geometry(1, pane);
    const { shown, shownTable: table, state } = pane;
    const whole = wholeBox(pane);
    if (!geometry || !shown || !table || !whole) return null;
    const { grid, stream } = shown.loaded;
    const ground = geometry.ground(x, y);
    const ray = new Ray(geometry, x, y);
    const way = wayWithin(ray, croppedBox(whole, state.layers.crop)) ?? [];
    const points = [...way, ...(ground ? [ground] : [])];
    const isAlong = boundsAbout(points, grid) !== null; // the ray meets columns of the grid
    const cells = isAlong && (asks || !stream) ? pane.windows.ray(shown.loaded, points) : null;
    const seen = foundOn({ ray, grid, table, cells, whole, ground }, pane);
    if (!seen) return null;
    const { layer } = seen;
    const isThrough = state.layers.hasVolume || pane.drawn?.surface != null;
    return {
        ...seen,
        place: planeOf(grid).toPlace(seen.at),
        lacksCells:
            !cells && isAlong && layer !== 'outside' && (isThrough || layer === 'maximum' || layer === 'ground'),
        // A section, a plane and the maximum are read from the cells that are drawn; all other layers are read from
        // cells along the ray.
        halvings:
            layer === 'sweep'
                ? 0
                : pane.windows.halvings(
                      shown.loaded,
                      layer === 'section' ? layer : layer === 'plane' || layer === 'maximum' ? 'layers' : 'ray',
                  ),
    };
}
