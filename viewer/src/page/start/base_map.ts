// The lines below the start map: coarse ones of all that it shows, finer ones of where it is looked at.

import { MapBox, MapView, boxBetween, grownBox, holdsBox } from '../../map/mercator';
import { City, map } from '../../wire/api';
import { MapPaths, mapPaths } from './painter';

const fineFromScale = 8000; // pixels of the earth, from which finer lines are worth their bytes
const finestFromScale = 24000;
const settledAfterMs = 250;
const mostLatitudeDeg = 85; // of a box of lines

interface Area {
    box: MapBox;
    detail: number;
    paths: MapPaths;
}

export class BaseMap {
    private coarse: Area | null = null;
    private fine: Area | null = null;
    private timer = 0;
    private isComing = false; // the coarse lines

    constructor(private loaded: () => void) {}

    // The greatest cities of all that is shown.
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

    // The lines for a view; others, and finer ones, are loaded once it rests.
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

    private async refine(box: MapBox, withCounties: boolean): Promise<void> {
        // If there are too many lines, the coarse ones stay.
        const area = await this.load(box, 0, withCounties).catch(() => null);
        if (area) this.fine = area;
        if (area) this.loaded();
    }

    private async load(box: MapBox, detail: number, withCounties = false): Promise<Area> {
        return { box, detail, paths: mapPaths(await map(box, detail, withCounties)) };
    }
}
