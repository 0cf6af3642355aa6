// Loads the map below a grid. Gives lines and water to the renderer, and names to the labels.

import { boxAbout } from '../map/mercator';
import { Renderer } from '../renderer/renderer';
import { WaterMask } from '../renderer/water_texture';
import { boxOf } from '../scene/grid_box';
import { MapLines, Mark, cityMarks, mapLines, projected, ringLines } from '../scene/ground_lines';
import { halfWidthsM, planeOf } from '../earth/projection';
import { ringsOf } from '../scene/water';
import { MapAnswer, map } from '../wire/api';
import { GridPlace, PackedGrid } from '../wire/packed_grid';
import { App, Shown } from './app';
import { waterMask } from './water_mask';

// Factor from the size of the grid to the size of the map, which is also seen beyond the grid.
const widerThanGrid = 1.4;
const coarseFromM = 6e5;
// The first picture of a grid does not wait for the lines of the dense kinds.
const firstKinds = ['interstate', 'state', 'lake', 'country', 'coast', 'city'] as const;
const denseKinds = ['county', 'highway'] as const;

async function mapAround(place: GridPlace, kinds: typeof firstKinds | typeof denseKinds): Promise<MapAnswer> {
    const plane = planeOf(place);
    const [halfXM, halfYM] = halfWidthsM(place);
    const corners = [-1, 0, 1].flatMap((x) =>
        [-1, 0, 1].map((y) => plane.toPlace([x * widerThanGrid * halfXM, y * widerThanGrid * halfYM])),
    );
    const box = boxAbout(plane.toPlace([0, 0]).longitudeDeg, corners);
    return map(
        { ...box, south: Math.max(-89, box.south), north: Math.min(89, box.north) },
        isCoarse(place) ? 1 : 0,
        kinds,
    );
}

const isCoarse = (place: GridPlace): boolean => halfWidthsM(place)[0] > coarseFromM;

interface MapOnPlane {
    lines: MapLines[];
    isWhole: boolean; // the lines of all kinds have come
    water: WaterMask;
    cities: Mark[];
}

async function projectedMap(place: GridPlace): Promise<MapOnPlane> {
    const found = await mapAround(place, firstKinds);
    const plane = planeOf(place);
    const [halfXM, halfYM] = halfWidthsM(place);
    const all = projected(found, plane);
    return {
        lines: mapLines(all, Math.max(halfXM, halfYM)),
        isWhole: isCoarse(place),
        water: waterMask(
            ringsOf(all, 'coast', plane),
            ringsOf(all, 'lake', plane),
            widerThanGrid * halfXM,
            widerThanGrid * halfYM,
        ),
        cities: cityMarks(found.cities, plane, halfXM, halfYM),
    };
}

async function denseLines(place: GridPlace): Promise<MapLines[]> {
    const found = projected(await mapAround(place, denseKinds), planeOf(place));
    return mapLines(found, Math.max(...halfWidthsM(place)));
}

const keyOf = (domain: string, { nx, ny, spacing, centerDeg, offsetCells }: GridPlace): string =>
    `${domain} ${nx} ${ny} ${spacing} ${centerDeg.join()} ${offsetCells.join()}`;

export class Ground {
    marks: Mark[] = [];
    isWaiting = false; // the map has not come
    private asked: { key: string; found: Promise<MapOnPlane | null> } | null = null;
    private shownKey = '';
    private shown: { grid: PackedGrid; found: MapOnPlane | null } | null = null;
    private isFlat = false; // the ground is that of 2D
    private isCompleting = false; // lines of dense kinds are being loaded

    constructor(
        private app: App,
        private renderer: Renderer,
        private redraw: () => void,
    ) {
        app.on('view', () => {
            if (this.shown && this.isFlat !== app.state.isFlat) this.put(this.shown.grid, this.shown.found);
        });
    }

    forget(): void {
        this.shownKey = '';
    }

    // Asks for the map of a grid before the grid has come. Returns its lines; null if they cannot be loaded.
    async expect(domain: string, place: GridPlace): Promise<MapLines[] | null> {
        return domain === this.app.state.domain ? ((await this.ask(domain, place))?.lines ?? null) : null;
    }

    // Returns the map of a grid; null if it cannot be loaded. The page then shows the grid without a map.
    private ask(domain: string, place: GridPlace): Promise<MapOnPlane | null> {
        const key = keyOf(domain, place);
        if (this.asked?.key === key) return this.asked.found;
        const found = projectedMap(place).catch(() => {
            if (this.asked?.key === key) this.asked = null; // the next grid asks again
            return null;
        });
        this.asked = { key, found };
        return found;
    }

    async show({ domain, loaded }: Shown): Promise<void> {
        const { grid } = loaded;
        const place = keyOf(domain, grid);
        // The sites are in the key, because a region has different sites at different times.
        const key = `${place} ${this.app.state.units.distance.name} ${grid.sites.map((site) => site.icao).join()}`;
        if (this.shownKey === key) return;
        // Do not keep the map of another place below the grid.
        if (!this.shownKey.startsWith(`${place} `)) this.put(grid, null);
        this.shownKey = key;
        this.isWaiting = true;
        const found = await this.ask(domain, grid);
        if (this.shownKey !== key) return;
        this.isWaiting = false;
        if (!found) this.shownKey = '';
        if (found && this.app.state.domain === domain) this.put(grid, found);
        this.redraw();
    }

    // Adds the lines of the dense kinds to a map that lacks them. If they cannot be loaded, the next call tries again.
    async complete(): Promise<void> {
        if (!this.shown?.found || this.shown.found.isWhole || this.isCompleting) return;
        const { grid, found } = this.shown;
        this.isCompleting = true;
        const lines = await denseLines(grid).catch(() => null);
        this.isCompleting = false;
        if (!lines) return;
        found.lines.unshift(...lines);
        found.isWhole = true;
        if (this.shown.found !== found) return;
        this.put(this.shown.grid, found);
        this.redraw();
    }

    // Shows rings about the sites, the border of the grid in 3D, and the map if it was found.
    private put(grid: PackedGrid, found: MapOnPlane | null): void {
        this.shown = { grid, found };
        this.isFlat = this.app.state.isFlat;
        const { halfXM, halfYM } = boxOf(grid);
        const rings = ringLines(grid.sites, planeOf(grid), halfXM, halfYM, this.app.state.units);
        const lines = rings.lines.filter(({ kind }) => kind !== 'border' || !this.isFlat);
        this.renderer.showLines([...(found?.lines ?? []), ...lines]);
        this.renderer.showWater(found?.water ?? null);
        this.marks = [...rings.marks, ...(found?.cities ?? [])];
        document.documentElement.dataset['ground'] = !found ? 'none' : found.isWhole ? 'whole' : 'part';
    }
}
