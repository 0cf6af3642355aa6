// The composites of domains as tiles of the data server (docs/web/pictures.md), loaded a few at a time.

import { Tile } from '../../map/mercator';
import { address } from '../../wire/api';

const mostAtOnce = 4;
const mostKept = 400;
const againAfterMs = 1500; // the server draws a few pictures at a time, and says so
const longestPause = 10; // times that; a tile is asked for until it comes: without it the map shows no echo there
const toldAfterTries = 2;

interface Kept {
    image: HTMLImageElement;
    isThere: boolean;
    tries: number;
}

// What is drawn as the ground: a domain at a time of its newest grid.
export interface Picture {
    domain: string;
    time: string;
}

export class Tiles {
    private kept = new Map<string, Kept>(); // the least recently asked first
    private waiting: string[] = [];
    private loading = 0;
    lacks = false; // some tile of what was drawn last did not come

    constructor(private loaded: () => void) {}

    private static path({ domain, time }: Picture, { zoom, column, row }: Pick<Tile, 'zoom' | 'column' | 'row'>): string {
        return `tiles/${encodeURIComponent(domain)}/composite.REF/${encodeURIComponent(time)}/${zoom}/${column}/${row}.png`;
    }

    // What waits to be loaded is forgotten: another view is drawn.
    begin(): void {
        for (const path of this.waiting) this.kept.delete(path);
        this.waiting = [];
        this.lacks = false;
    }

    // Draws a tile, or the part of a coarser one that is there, and asks for it.
    draw(pen: CanvasRenderingContext2D, picture: Picture, tile: Tile): void {
        const own = this.find(Tiles.path(picture, tile));
        if (own) {
            pen.drawImage(own, tile.x, tile.y, tile.side, tile.side);
            return;
        }
        for (let up = 1; up <= Math.min(5, tile.zoom); ++up) {
            const [column, row] = [tile.column >> up, tile.row >> up];
            const coarse = this.kept.get(Tiles.path(picture, { zoom: tile.zoom - up, column, row }));
            if (!coarse?.isThere) continue;
            const side = coarse.image.width / 2 ** up;
            pen.drawImage(coarse.image, (tile.column - (column << up)) * side, (tile.row - (row << up)) * side, side, side, tile.x, tile.y, tile.side, tile.side);
            return;
        }
    }

    private find(path: string): HTMLImageElement | null {
        const known = this.kept.get(path);
        if (known) {
            this.kept.delete(path);
            this.kept.set(path, known);
            this.lacks ||= !known.isThere && known.tries >= toldAfterTries;
            return known.isThere ? known.image : null;
        }
        this.kept.set(path, { image: new Image(), isThere: false, tries: 0 });
        this.waiting.push(path);
        this.next();
        for (const old of this.kept.keys()) {
            if (this.kept.size <= mostKept) break;
            this.kept.delete(old);
        }
        return null;
    }

    private next(): void {
        while (this.loading < mostAtOnce) {
            const path = this.waiting.shift();
            if (path === undefined) return;
            const kept = this.kept.get(path);
            if (!kept) continue;
            ++this.loading;
            kept.image.onload = () => {
                kept.isThere = true;
                this.ended();
                this.loaded();
            };
            kept.image.onerror = () => {
                this.ended();
                window.setTimeout(() => this.again(path), againAfterMs * Math.min(++kept.tries, longestPause));
                if (kept.tries === toldAfterTries) this.loaded();
            };
            kept.image.src = address(path);
        }
    }
    private ended(): void {
        --this.loading;
        this.next();
    }
    private again(path: string): void {
        if (!this.kept.has(path)) return;
        this.waiting.push(path);
        this.next();
    }
}
