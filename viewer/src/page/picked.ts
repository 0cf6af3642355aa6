// What is under a pixel of the picture: the first visible echo, else the ground.

import { croppedBox } from '../scene/layers';
import { firstVisible } from '../scene/first_visible';
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
    groundCode: number | null; // of the lowest cell above it, where there is no value; null: its codes are not here
}

export function pick(app: App, drawing: Drawing, x: number, y: number): Picked | null {
    const geometry = drawing.geometry();
    const { shown, table, state } = app;
    if (!geometry || !shown || !table) return null;
    const { grid, stream } = shown.loaded;
    const plane = planeOf(grid);
    const { halfXM, halfYM, bottomM, topM } = boxOf(grid);
    const whole = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM, bottomM, topM };
    const isVisible = (value: number) => value >= (state.least ?? -Infinity) && extinctionPerM(table, value, state.opacity) > 0;
    const seen = state.layers.hasVolume && !stream ? firstVisible(grid, geometry, croppedBox(whole, state.layers.crop), x, y, isVisible) : null;
    if (seen) return { at: seen.at, place: plane.toPlace(seen.at), heightM: seen.heightM, value: seen.value, groundCode: null };
    const at = geometry.ground(x, y);
    const column = at && columnAt(grid, ...at);
    if (!at || !column) return null;
    return { at, place: plane.toPlace(at), heightM: geometry.groundM, value: null, groundCode: stream ? null : codeAt(grid, ...column, 0) };
}
