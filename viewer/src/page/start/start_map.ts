// Shows the map of all stations, from which a user opens a station or domain by a click, a touch, keys or the list.

import {
    MapBox,
    MapView,
    boxBetween,
    draggedMap,
    fittedMap,
    isInBox,
    mapPoint,
    pixelOf,
    reaches,
    scaledMap,
} from '../../map/mercator';
import { Pixel, StationPlace, isInside, nearestPixel, pixelToward, search } from '../../map/places';
import { isRegion, regionName } from '../../wire/api';
import { App } from '../app';
import { button, element, pixelRatio } from '../dom';
import { Rect } from '../labels';
import { mapTexts } from '../later_texts';
import { texts } from '../texts';
import { BaseMap } from './base_map';
import { mapLegend } from '../map_legend';
import { MapPointers } from './map_pointers';
import { Outline, StartScene, paint, pixelsOf } from './painter';
import { PlaceList, ListedPlace, agedText, listedStation } from './place_list';
import { StartData } from './start_data';
import { Tiles } from './tiles';

const reach = 28; // a pointer chooses a station within this many pixels
const lookAgainAfterMs = 30_000;
const lookSoonAfterMs = 1000; // after news of another grid
const mostScaleAtFirst = 12_000; // so that the first view of a lone station shows its surroundings
const toldAfterMs = 1000; // if echo takes longer to load, the page says that it is loading
const edge = 60; // margin about the stations, in pixels

export class StartMap {
    private readonly canvas = element<HTMLCanvasElement>('map');
    private readonly page = element('start');
    private readonly tiles = new Tiles(() => this.draw());
    private readonly base = new BaseMap(() => this.draw());
    private readonly data = new StartData(() => this.takeData());
    private readonly list: PlaceList;
    private view: MapView | null = null;
    private chosen: string | null = null;
    private box: [Pixel, Pixel] | null = null;
    private anchor: string | null = null; // station at which the user began a box by keys
    private isDrawing = false;
    private timer = 0;
    private soon = 0; // timer after news
    private isMoved = false; // the user has moved the map
    private said = '';
    private lacksSince = Infinity; // time in ms since which echo is missing; Infinity if none is missing
    boxes = false; // a drag makes a box instead of moving the map

    constructor(private app: App) {
        this.list = new PlaceList({
            point: (domain) => this.choose(domain, false),
            open: (domain) => void this.open(domain),
            search: () => this.putList(),
        });
    }

    begin(): void {
        element('start-title').textContent = mapTexts.title;
        element('start-help').textContent = mapTexts.help;
        element('start-actions').append(
            button('start-box', mapTexts.box, () => this.toggleBoxes()),
            button('start-all', mapTexts.all, () => this.fitAll()),
            button('start-back', mapTexts.back, () => this.goBack()),
        );
        this.canvas.setAttribute('aria-label', mapTexts.mapLabel);
        this.canvas.addEventListener('keydown', (event) => this.press(event));
        new MapPointers(this.canvas, this).begin();
        window.addEventListener('resize', () => this.resize());
        document.addEventListener('visibilitychange', () => !this.page.hidden && void this.look());
        this.app.on('map', () => this.show(this.app.isOnMap));
        this.app.on('choices', () => {
            window.clearTimeout(this.soon);
            if (!this.page.hidden) this.soon = window.setTimeout(() => void this.look(), lookSoonAfterMs);
        });
        this.show(this.app.isOnMap);
    }

    // -- drawing

    private show(isShown: boolean): void {
        const was = !this.page.hidden;
        this.page.hidden = !isShown;
        document.querySelector('main')!.inert = isShown;
        window.clearInterval(this.timer);
        if (!isShown) return;
        element('start-back').hidden = this.app.shown === null;
        document.title = `${mapTexts.title} · ${texts.title}`;
        this.timer = window.setInterval(() => void this.look(), lookAgainAfterMs);
        if (!was) {
            this.canvas.focus();
            void this.look();
        }
        this.draw();
    }

    private putLegend(): void {
        const box = element('start-legend');
        const table = this.app.book?.usualOf('REF');
        if (table && !box.hasChildNodes()) box.append(...mapLegend(table));
    }

    private async look(): Promise<void> {
        if (document.hidden) return;
        try {
            await this.app.findDomains();
            await this.data.load(
                this.app.domains.filter((one) => !isRegion(one.domain)),
                this.chosen,
            );
        } catch (error) {
            this.say(texts.failed(error instanceof Error ? error.message : String(error)));
        }
    }

    private takeData(): void {
        if (this.page.hidden) return;
        this.putLegend();
        this.putList(); // before the view is fitted into the room beside the list
        const isFirst = this.view === null;
        // Take in stations that come later, until the user moves the map.
        const view = this.isMoved ? null : this.fit();
        if (view && isFirst) {
            this.base.begin(boxBetween(view, [0, 0], [view.width, view.height])).then(
                () => this.putList(),
                (error: unknown) => this.say(texts.failed(String(error))),
            );
        }
        this.tellChosen();
        this.draw();
    }

    private fitAll(): void {
        this.isMoved = false;
        this.fit();
    }

    // Fits the view to all mosaics and stations. A few stations on other continents would shrink the map. So if at
    // least 80 % of the stations are within 65 degrees of longitude of their median, leaves out the other stations.
    // Returns null if there is nothing to show.
    private fit(): MapView | null {
        const { stations, mosaics } = this.data;
        const middleDeg = stations.map((one) => one.longitudeDeg).sort((a, b) => a - b)[
            Math.floor(stations.length / 2)
        ];
        const near = stations.filter((one) => Math.abs(one.longitudeDeg - (middleDeg ?? 0)) < 65);
        const main = near.length >= 0.8 * stations.length ? near : stations;
        const points = [...main, ...mosaics.flatMap(({ outline }) => outline?.places ?? [])].map(mapPoint);
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (width === 0 || points.length === 0) return null;
        const list = element('places').getBoundingClientRect();
        const isBeside = list.height > height / 2;
        const clear: [number, number, number, number] = [
            edge + (isBeside ? list.right : 0),
            edge + element('start-head').getBoundingClientRect().bottom,
            edge,
            edge + (isBeside ? 0 : height - list.top),
        ];
        this.view = fittedMap(points, width, height, clear, mostScaleAtFirst);
        this.draw();
        return this.view;
    }

    private resize(): void {
        if (!this.view || this.page.hidden) return;
        this.view = { ...this.view, width: this.canvas.clientWidth, height: this.canvas.clientHeight };
        this.draw();
    }

    draw(): void {
        if (this.isDrawing || this.page.hidden) return;
        this.isDrawing = true;
        requestAnimationFrame(() => {
            this.isDrawing = false;
            this.drawNow();
        });
    }

    private drawNow(): void {
        const { view, canvas } = this;
        if (!view) return;
        const ratio = pixelRatio();
        const [width, height] = [Math.round(view.width * ratio), Math.round(view.height * ratio)];
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
        paint(canvas.getContext('2d')!, this.scene(view), this.tiles, ratio);
        const lacks = this.tiles.lacks || this.data.lacks;
        if (lacks && this.lacksSince === Infinity) window.setTimeout(() => this.draw(), toldAfterMs);
        this.lacksSince = lacks ? Math.min(this.lacksSince, performance.now()) : Infinity;
        this.putCard();
        // Publish the positions of the stations for tests of the page.
        const places = this.data.stations.map((one) =>
            [one.icao, ...pixelOf(view, mapPoint(one)).map(Math.round)].join(' '),
        );
        document.documentElement.dataset['map'] = places.join();
    }

    private scene(view: MapView): StartScene {
        const { data, app } = this;
        const mosaics = data.mosaics
            .map(({ outline }) => outline)
            .filter((one): one is NonNullable<typeof one> => one !== null);
        const polygons = new Map(mosaics.map((one) => [one, pixelsOf(view, one)]));
        const middle: Pixel = [view.width / 2, view.height / 2];
        const away = (one: StationPlace): number => {
            const [x, y] = pixelOf(view, mapPoint(one));
            return Math.hypot(x - middle[0], y - middle[1]);
        };
        const visible = data.stations
            .filter((one) => reaches(view, one, data.reachM))
            .sort((a, b) => away(a) - away(b));
        const isWithin = (outline: Outline, one: StationPlace) =>
            isInside(polygons.get(outline)!, ...pixelOf(view, mapPoint(one)));
        return {
            view,
            map: this.base.for(view),
            pictures: data.pictures(app.domains, visible, isWithin).map(({ domain, facts, outline }) => ({
                domain: domain.domain,
                time: StartData.pictureTime(domain)!,
                id: facts.id,
                outline,
                within: boundsOf(pixelsOf(view, outline)),
            })),
            outlines: mosaics,
            stations: data.stations,
            chosen: this.chosen,
            box: this.box,
            boxed: new Set(this.stationsInBox().map((one) => one.icao)),
            covered: ['start-head', 'places'].map((id) => element(id).getBoundingClientRect()),
        };
    }

    // -- pointer

    move(dx: number, dy: number): void {
        if (this.view) this.view = draggedMap(this.view, dx, dy);
        this.isMoved = true;
        this.draw();
    }
    zoom(factor: number, x?: number, y?: number): void {
        if (this.view) this.view = scaledMap(this.view, factor, x, y);
        this.isMoved = true;
        this.draw();
    }

    // Returns the station near a pixel, else the smallest domain around the pixel; null if there is none.
    at(x: number, y: number): string | null {
        const { view, data } = this;
        if (!view) return null;
        const nearest = nearestPixel(
            data.stations.map((one) => pixelOf(view, mapPoint(one))),
            x,
            y,
            reach,
        );
        if (nearest >= 0) return data.stations[nearest]!.icao;
        const around = data.mosaics
            .filter(({ outline }) => outline && isInside(pixelsOf(view, outline), x, y))
            .sort((a, b) => sideOf(a.facts) - sideOf(b.facts));
        return around[0]?.domain.domain ?? null;
    }

    point(x: number, y: number): void {
        const domain = this.at(x, y);
        this.canvas.style.cursor = this.boxes ? 'crosshair' : domain ? 'pointer' : 'grab';
        this.choose(domain);
    }

    private choose(domain: string | null, follows = true): void {
        if (domain === this.chosen) return;
        this.chosen = domain;
        if (follows) this.list.mark(domain);
        this.tellChosen();
        this.draw();
    }

    private tellChosen(): void {
        const station = this.data.stations.find((one) => one.icao === this.chosen);
        const domain = this.app.domains.find((one) => one.domain === this.chosen);
        if (this.chosen === null || (!station && !domain)) return this.say('');
        const seen =
            domain && (this.data.mosaics.find((one) => one.domain.domain === this.chosen) ?? this.data.find(domain));
        const ofDomain = domain?.moments[0];
        const told = station ? agedText(station) : ofDomain ? texts.start.age(ofDomain.age_s, ofDomain.newest) : null;
        const moments = domain?.moments.map((one) => one.moment) ?? [];
        const strongest = moments.includes('REF') ? (seen?.facts?.greatest ?? null) : null;
        this.say(mapTexts.card(this.chosen, station?.name ?? '', told, moments, strongest));
    }
    private say(text: string): void {
        this.said = text;
        this.putCard();
    }
    private putCard(): void {
        const card = [
            this.said,
            this.data.unpictured > 0 ? mapTexts.unpictured(this.data.unpictured) : '',
            performance.now() - this.lacksSince >= toldAfterMs ? mapTexts.lacksEcho : '',
        ]
            .filter(Boolean)
            .join(' ');
        if (element('start-card').textContent !== card) element('start-card').textContent = card;
    }

    async open(domain: string | null): Promise<void> {
        if (domain === null) return;
        if (!this.app.domains.some((one) => one.domain === domain)) return this.say(mapTexts.noGridsOf(domain));
        await this.app.enter(domain);
    }

    private goBack(): void {
        if (this.app.shown) void this.app.enter(this.app.state.domain);
    }

    // -- a box over several sites

    private toggleBoxes(): void {
        this.boxes = !this.boxes;
        this.isMoved = true; // so that the map stays where the user draws
        element('start-box').setAttribute('aria-pressed', String(this.boxes));
        this.canvas.focus();
    }
    drawBox(from: Pixel, to: Pixel): void {
        this.box = [from, to];
        this.tellBox();
        this.draw();
    }
    dropBox(): void {
        this.box = null;
        this.anchor = null;
        this.draw();
    }
    private boxDegrees(): MapBox | null {
        return this.view && this.box && boxBetween(this.view, ...this.box);
    }
    private stationsInBox(): StationPlace[] {
        const box = this.boxDegrees();
        return box ? this.data.stations.filter((one) => one.hasGrids && isInBox(one, box)) : [];
    }
    private tellBox(): void {
        this.say(mapTexts.boxed(this.stationsInBox().map((one) => one.icao)));
    }
    // Opens the region of the box, or the station if the box holds just one. If the box holds no station, tells the
    // user.
    async openBox(): Promise<void> {
        const box = this.boxDegrees();
        const inside = this.stationsInBox();
        this.dropBox();
        if (!box || inside.length === 0) return this.say(mapTexts.boxed([]));
        if (inside.length === 1) return this.open(inside[0]!.icao);
        this.say(mapTexts.merging(inside.map((one) => one.icao)));
        const domain = regionName(box);
        try {
            await this.app.findRegion(domain);
            await this.app.enter(domain);
            this.say('');
        } catch (error) {
            this.say(error instanceof Error ? error.message : String(error));
        }
    }

    // -- keys

    private press(event: KeyboardEvent): void {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const ways: Record<string, Pixel> = {
            ArrowLeft: [-1, 0],
            ArrowRight: [1, 0],
            ArrowUp: [0, -1],
            ArrowDown: [0, 1],
        };
        const way = ways[event.key];
        const actions: Record<string, () => void> = {
            '+': () => this.zoom(1.5),
            '=': () => this.zoom(1.5),
            '-': () => this.zoom(1 / 1.5),
            '0': () => void this.fit(),
            '/': () => this.list.field.focus(),
            b: () => this.boxByKeys(),
            Enter: () => void (this.anchor ? this.openBox() : this.open(this.chosen)),
            Escape: () => (this.box ? this.dropBox() : this.goBack()),
        };
        const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (way && event.shiftKey) this.move(-80 * way[0], -80 * way[1]);
        else if (way) this.step(way);
        else if (action) action();
        else return;
        event.preventDefault();
    }

    // Chooses the next station in a direction from the chosen station. If no station is chosen, chooses the station
    // nearest to the middle of the map.
    private step(way: Pixel): void {
        const { view, data } = this;
        if (!view || data.stations.length === 0) return;
        const pixels = data.stations.map((one) => pixelOf(view, mapPoint(one)));
        const now = data.stations.findIndex((one) => one.icao === this.chosen);
        const next =
            now < 0
                ? nearestPixel(pixels, view.width / 2, view.height / 2, Infinity)
                : pixelToward(pixels, pixels[now]!, way);
        if (next < 0) return;
        this.choose(data.stations[next]!.icao);
        this.bringIn(view, pixels[next]!);
        if (this.anchor) this.boxToChosen();
    }
    private bringIn({ width, height }: MapView, [x, y]: Pixel): void {
        const left =
            element('places').getBoundingClientRect().right < width / 2
                ? element('places').getBoundingClientRect().right
                : 0;
        const [dx, dy] = [
            Math.max(0, left + edge - x) - Math.max(0, x - width + edge),
            Math.max(0, edge + 60 - y) - Math.max(0, y - height + edge),
        ];
        if (dx !== 0 || dy !== 0) this.move(dx, dy);
    }

    // Begins a box at the chosen station; arrows then widen the box. Drops the box if keys have begun one already. If
    // nothing is chosen, begins or ends the mode in which drags make boxes.
    private boxByKeys(): void {
        if (this.anchor) return this.dropBox();
        this.anchor = this.chosen;
        if (this.anchor) this.boxToChosen();
        else this.toggleBoxes();
    }
    private boxToChosen(): void {
        const { view, data } = this;
        const pixels = [this.anchor, this.chosen].map((icao) => {
            const station = data.stations.find((one) => one.icao === icao);
            return view && station && pixelOf(view, mapPoint(station));
        });
        const [a, b] = pixels;
        if (!a || !b) return;
        const grow = 12;
        this.drawBox(
            [Math.min(a[0], b[0]) - grow, Math.min(a[1], b[1]) - grow],
            [Math.max(a[0], b[0]) + grow, Math.max(a[1], b[1]) + grow],
        );
    }

    // -- the list

    private putList(): void {
        const word = this.list.field.value;
        const domains: ListedPlace[] = this.data.mosaics
            .filter(({ domain }) => domain.domain.toLowerCase().includes(word.trim().toLowerCase()))
            .map(({ domain }) => ({
                domain: domain.domain,
                name: mapTexts.mosaic,
                note: domain.moments[0] ? texts.start.age(domain.moments[0].age_s, domain.moments[0].newest) : '',
                isThere: true,
            }));
        this.list.put([...domains, ...search(this.data.stations, this.base.cities, word).map(listedStation)]);
        this.list.mark(this.chosen);
    }
}

function boundsOf(pixels: Pixel[]): Rect {
    const [xs, ys] = [pixels.map(([x]) => x), pixels.map(([, y]) => y)];
    return { left: Math.min(...xs), top: Math.min(...ys), right: Math.max(...xs), bottom: Math.max(...ys) };
}

function sideOf(facts: { nx: number; ny: number; spacing_m?: number; spacing_deg?: number } | null): number {
    return facts ? facts.nx * facts.ny * (facts.spacing_m ?? (facts.spacing_deg ?? 1) * 111_000) ** 2 : Infinity;
}
