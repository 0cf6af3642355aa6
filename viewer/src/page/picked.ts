// What is under a pixel of the picture: the first visible echo, else the ground.

import { croppedBox } from '../scene/layers';
import { firstVisible, wayWithin } from '../scene/first_visible';
import { Place, Plane, planeOf } from '../scene/projection';
import { extinctionPerM } from '../tables/color_table';
import { App } from './app';
import { Drawing } from './drawing';
import { boxOf } from '../scene/grid_box';
import { columnAt } from './reading';
import { codeAt } from '../wire/packed_grid';

export interface Picked {
    at: Plane;
    place: Place;
    heightM: number;
    value: number | null; // null: no echo is visible there, and this is the ground
    groundCode: number | null; // of the lowest cell above it, where there is no value; null: not known here
    halvings: number; // how often the cells were halved that were read: 0 if they are the grid's own
}

// Of a grid in parts the cells along the ray are asked for if `asks`; until they have come it is the ground.
export function pick(app: App, drawing: Drawing, x: number, y: number, asks: boolean): Picked | null {
    const geometry = drawing.geometry();
    const { shown, table, state } = app;
    if (!geometry || !shown || !table) return null;
    const plane = planeOf(shown.loaded.grid);
    const { halfXM, halfYM, bottomM, topM } = boxOf(shown.loaded.grid);
    const whole = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
    const box = croppedBox(whole, state.layers.crop);
    const at = geometry.ground(x, y);
    const way = state.layers.hasVolume ? wayWithin(geometry, box, x, y) : null;
    const points = [...(way ?? []), ...(at ? [at] : [])];
    const cells = points.length > 0 && (asks || !shown.loaded.stream) ? drawing.windows!.ray(shown.loaded, points) : null;
    const halvings = cells?.grid.halvings ?? 0;
    const isVisible = (value: number) => value >= (state.least ?? -Infinity) && extinctionPerM(table, value, state.opacity) > 0;
    const seen = way && cells && firstVisible(cells, geometry, box, x, y, isVisible);
    if (seen) return { at: seen.at, place: plane.toPlace(seen.at), heightM: seen.heightM, value: seen.value, groundCode: null, halvings };
    if (!at || !columnAt(shown.loaded.grid, ...at)) return null;
    const column = cells && columnAt(cells.grid, at[0] - cells.middle[0], at[1] - cells.middle[1]);
    const groundCode = cells && column && codeAt(cells.grid, ...column, 0);
    return { at, place: plane.toPlace(at), heightM: geometry.groundM, value: null, groundCode, halvings };
}
