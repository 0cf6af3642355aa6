// Loads the lines of the start map: coarse lines of all that it shows, and finer lines of a near view.

import { MapBox, MapView, boxBetween, grownBox, holdsBox } from '../../map/mercator';
import { City, map } from '../../wire/api';
import { MapPaths, mapPaths } from './painter';

const fineFromScale = 8000; // least scale of a view (pixels around the earth) for finer lines
const finestFromScale = 24000; // least scale for counties and roads
const usualKinds = ['state', 'lake', 'country', 'coast', 'city'] as const;
const finestKinds = ['county', 'highway', 'interstate', ...usualKinds] as const;
const settledAfterMs = 250;
const mostLatitudeDeg = 85; // limit of a box in the north and south

interface Area {
    box: MapBox;
    detail: number;
    paths: MapPaths;
}

export class BaseMap {
    private coarse: Area | null = null;
    private fine: Area | null = null;
    private timer = 0;
    private isComing = false; // coarse lines are being loaded

    constructor(private loaded: () => void) {}

    // Returns the greatest cities in the box of the coarse lines.
    get cities(): City[] {
        return this.coarse?.paths.cities ?? [];
    }

    async begin(box: MapBox): Promise<void> {
        if (this.isComing || (this.coarse && holdsBox(this.coarse.box, box))) return;
        this.isComing = true;
        try {
            this.coarse = await this.load(grownBox(box, 0.5), 1);
        } finally {
            this.isComing = false;
        }
        this.loaded();
    }

    // Returns the best lines that are here for a view; null if there are none. Once the view rests, loads the lines
    // that the view needs.
    for(view: MapView): MapPaths | null {
        const seen = boxBetween(view, [0, 0], [view.width, view.height]);
        const box = {
            ...seen,
            south: Math.max(-mostLatitudeDeg, seen.south),
            north: Math.min(mostLatitudeDeg, seen.north),
        };
        const isThere = (area: Area | null) => area !== null && holdsBox(area.box, box);
        const isFine = view.scale >= fineFromScale;
        const needsFine = isFine && !isThere(this.fine);
        window.clearTimeout(this.timer);
        if (needsFine || (!this.isComing && !isThere(this.coarse))) {
            this.timer = window.setTimeout(() => {
                if (needsFine) void this.refine(grownBox(box, 0.3), view.scale >= finestFromScale);
                void this.begin(box).catch(() => undefined);
            }, settledAfterMs);
        }
        return (isFine && isThere(this.fine) ? this.fine : this.coarse)?.paths ?? null;
    }

    private async refine(box: MapBox, isFinest: boolean): Promise<void> {
        // Keep the coarse lines if the server refuses the fine lines, because there are too many.
        const area = await this.load(box, 0, isFinest).catch(() => null);
        if (area) this.fine = area;
        if (area) this.loaded();
    }

    private async load(box: MapBox, detail: number, isFinest = false): Promise<Area> {
        return { box, detail, paths: mapPaths(await map(box, detail, isFinest ? finestKinds : usualKinds)) };
    }
}
