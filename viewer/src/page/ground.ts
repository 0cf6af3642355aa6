// The map below a grid: lines for the renderer, names for the labels.

import { Renderer } from '../renderer/renderer';
import { boxOf } from '../scene/grid_box';
import { Mark, cityMarks, mapLines, projected, ringLines } from '../scene/ground_lines';
import { planeOf } from '../scene/projection';
import { ringsOf } from '../scene/water';
import { MapAnswer, map } from '../wire/api';
import { PackedGrid } from '../wire/packed_grid';
import { App, Shown } from './app';
import { waterMask } from './water_mask';

// A margin, since the map is seen beyond the grid.
const widerThanGrid = 1.4;
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
    isWaiting = false; // for the map
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
        const place = `${domain} ${grid.nx} ${grid.ny} ${grid.spacing} ${grid.centerDeg.join()} ${grid.offsetCells.join()}`;
        const key = `${place} ${units.distance.name}`;
        if (this.mapOf === key) return;
        // No map of another place lies below the grid.
        if (!this.mapOf.startsWith(`${place} `)) this.put(loaded.grid, null);
        this.mapOf = key;
        this.isWaiting = true;
        // Without a map the grid alone is shown.
        const found = await mapAround(grid).catch(() => null);
        if (this.mapOf !== key) return;
        this.isWaiting = false;
        if (found && this.app.state.domain === domain) this.put(grid, found);
        this.redraw();
    }

    // The rings need no server.
    private put(grid: PackedGrid, found: MapAnswer | null): void {
        const plane = planeOf(grid);
        const { halfXM, halfYM } = boxOf(grid);
        const rings = ringLines(grid.sites, plane, halfXM, halfYM, this.app.state.units);
        const all = found ? projected(found, plane) : [];
        this.renderer.showLines([...mapLines(all, Math.max(halfXM, halfYM)), ...rings.lines]);
        const reach = [halfXM, halfYM].map(half => widerThanGrid * half) as [number, number];
        this.renderer.showWater(found && waterMask(ringsOf(all, 'coast', plane), ringsOf(all, 'lake', plane), ...reach));
        this.marks = [...rings.marks, ...(found ? cityMarks(found.cities, plane, halfXM, halfYM) : [])];
    }
}
