// Loads composites of domains as tiles from the data server (docs/web/pictures.md), a few at a time.

import { Tile } from '../../map/mercator';
import { address } from '../../wire/api';

const mostAtOnce = 4;
const mostKept = 400;
const againAfterMs = 1500; // pause after the first refusal, which the server gives while it draws other pictures
const longestPause = 10; // the pause grows with each refusal, up to this many times againAfterMs
const mostUp = 5; // until a tile comes, a tile that is at most this many zooms coarser is drawn instead

interface Kept {
    image: HTMLImageElement;
    isThere: boolean;
    tries: number;
}

// A composite of a domain at the time of its newest grid, which is drawn on the map.
export interface Picture {
    domain: string;
    time: string;
    id: string; // of the grid
}

type TilePlace = Pick<Tile, 'zoom' | 'column' | 'row'>;

export class Tiles {
    private kept = new Map<string, Kept>(); // by path and id, the least recently used first
    private waiting: string[] = [];
    private loading = 0;
    private drawn = new Map<string, Picture[]>(); // last and previous picture of each domain
    lacks = false; // some tile of the last view has not come

    constructor(private loaded: () => void) {}

    private static key({ domain, time, id }: Picture, { zoom, column, row }: TilePlace): string {
        return `tiles/${encodeURIComponent(domain)}/composite.REF/${encodeURIComponent(time)}/${zoom}/${column}/${row}.png#${id}`;
    }

    // Call before a view is drawn. Forgets the tiles that wait to be loaded.
    begin(): void {
        for (const key of this.waiting) this.kept.delete(key);
        this.waiting = [];
        this.lacks = false;
    }

    // Draws a tile, or asks for it. Until it comes, draws the tile of the previous picture, or a part of a coarser
    // tile.
    draw(pen: CanvasRenderingContext2D, picture: Picture, tile: Tile): void {
        const before = this.drawn.get(picture.domain) ?? [];
        if (before[0]?.id !== picture.id) this.drawn.set(picture.domain, [picture, ...before.slice(0, 1)]);
        const own = this.find(Tiles.key(picture, tile));
        if (own) return pen.drawImage(own, tile.x, tile.y, tile.side, tile.side);
        this.lacks = true;
        for (let up = 0; up <= Math.min(mostUp, tile.zoom); ++up) {
            const [column, row] = [tile.column >> up, tile.row >> up];
            const place = { zoom: tile.zoom - up, column, row };
            const other = this.drawn
                .get(picture.domain)!
                .map((one) => this.kept.get(Tiles.key(one, place)))
                .find((one) => one?.isThere);
            if (!other) continue;
            const side = other.image.width / 2 ** up;
            pen.drawImage(
                other.image,
                (tile.column - (column << up)) * side,
                (tile.row - (row << up)) * side,
                side,
                side,
                tile.x,
                tile.y,
                tile.side,
                tile.side,
            );
            return;
        }
    }

    private find(key: string): HTMLImageElement | null {
        const known = this.kept.get(key);
        if (known) {
            this.kept.delete(key);
            this.kept.set(key, known);
            return known.isThere ? known.image : null;
        }
        this.kept.set(key, { image: new Image(), isThere: false, tries: 0 });
        this.waiting.push(key);
        this.next();
        for (const old of this.kept.keys()) {
            if (this.kept.size <= mostKept) break;
            this.kept.delete(old);
        }
        return null;
    }

    private next(): void {
        while (this.loading < mostAtOnce) {
            const key = this.waiting.shift();
            if (key === undefined) return;
            const kept = this.kept.get(key);
            if (!kept) continue;
            ++this.loading;
            void this.load(key.split('#')[0]!, kept.image)
                .then(
                    () => {
                        kept.isThere = true;
                        this.loaded();
                    },
                    () =>
                        void window.setTimeout(
                            () => this.again(key),
                            againAfterMs * Math.min(++kept.tries, longestPause),
                        ),
                )
                .then(() => {
                    --this.loading;
                    this.next();
                });
        }
    }
    // Loads a tile. Asks the server even if the browser has cached the tile, because its grid may have been made again.
    private async load(path: string, image: HTMLImageElement): Promise<void> {
        const answer = await fetch(address(path), { cache: 'no-cache' });
        if (!answer.ok) throw new Error(answer.statusText);
        image.src = URL.createObjectURL(await answer.blob());
        await image.decode().finally(() => URL.revokeObjectURL(image.src));
    }
    private again(key: string): void {
        if (!this.kept.has(key)) return;
        this.waiting.push(key);
        this.next();
    }
}
