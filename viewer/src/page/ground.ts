// The map below a grid: lines for the renderer, names for the labels.

import { Renderer } from '../renderer/renderer';
import { boxOf } from '../scene/grid_box';
import { Mark, cityMarks, mapLines, ringLines } from '../scene/ground_lines';
import { planeOf } from '../scene/projection';
import { MapAnswer, map } from '../wire/api';
import { PackedGrid } from '../wire/packed_grid';
import { App, Shown } from './app';

// A margin, since the map is seen beyond the grid.
const widerThanGrid = 1.6;
const coarseFromM = 6e5;

async function mapAround(grid: PackedGrid): Promise<MapAnswer> {
    const plane = planeOf(grid);
    const { halfXM, halfYM } = boxOf(grid);
    const corners = [-1, 0, 1].flatMap(x => [-1, 0, 1].map(y => plane.toPlace([x * widerThanGrid * halfXM, y * widerThanGrid * halfYM])));
    const degrees = (name: 'latitudeDeg' | 'longitudeDeg') => corners.map(corner => corner[name]);
    return map(
        Math.max(-180, Math.min(...degrees('longitudeDeg'))),
        Math.max(-89, Math.min(...degrees('latitudeDeg'))),
        Math.min(180, Math.max(...degrees('longitudeDeg'))),
        Math.min(89, Math.max(...degrees('latitudeDeg'))),
        halfXM > coarseFromM ? 1 : 0,
    );
}

export class Ground {
    marks: Mark[] = [];
    private mapOf = '';

    constructor(
        private app: App,
        private renderer: Renderer,
        private redraw: () => void,
    ) {}

    forget(): void {
        this.mapOf = '';
    }

    async show({ domain, loaded }: Shown): Promise<void> {
        const { grid } = loaded;
        const { units } = this.app.state;
        const key = `${domain} ${grid.nx} ${grid.ny} ${grid.spacing} ${grid.centerDeg.join()} ${grid.offsetCells.join()} ${units.distance.name}`;
        if (this.mapOf === key) return;
        this.mapOf = key;
        const plane = planeOf(grid);
        const { halfXM, halfYM } = boxOf(grid);
        // Without a map the grid alone is shown.
        const found = await mapAround(grid).catch(() => ({ credit: '', lines: [], cities: [] }));
        if (this.mapOf !== key || this.app.state.domain !== domain) return;
        const rings = ringLines(grid.sites, plane, halfXM, halfYM, units);
        this.renderer.showLines([...mapLines(found, plane, Math.max(halfXM, halfYM)), ...rings.lines]);
        this.marks = [...rings.marks, ...cityMarks(found.cities, plane, halfXM, halfYM)];
        this.redraw();
    }
}
