// Draws the start map: land, echo, lines, outlines, stations and their names.

import { MapView, Tile, mapPoint, nearestCopy, pixelOf, tilesOf } from '../../map/mercator';
import { Pixel, StationPlace } from '../../map/places';
import { shades } from '../../renderer/shades';
import { withoutCuts } from '../../scene/ground_lines';
import { Place } from '../../earth/projection';
import { isAhead } from '../../time/timeline';
import { City, MapAnswer } from '../../wire/api';
import { fontOf, textScale } from '../dom';
import { Rect, haloed, overlaps } from '../labels';
import { Picture, Tiles } from './tiles';

const color = ([r, g, b, a = 255]: readonly number[]): string => `rgba(${r}, ${g}, ${b}, ${a / 255})`;
const sea = color(shades.page);
const land = color(shades.notSeen);
const accent = '#7db8f0';
const freshS = 20 * 60;

// Areas and lines of the map as paths in the square of the earth (map/mercator.ts).
export interface MapPaths {
    areas: { land: Path2D; lakes: Path2D };
    lines: { path: Path2D; color: string; width: number }[];
    cities: City[];
}

function pathOf(lines: [number, number][][]): Path2D {
    const path = new Path2D();
    for (const line of lines) {
        // Shift lines that are east of 180 degrees, because the page draws each copy of the earth from 180 west to 180
        // east.
        const turn = line.some(([longitudeDeg]) => longitudeDeg > 180) ? 1 : 0;
        line.forEach(([longitudeDeg, latitudeDeg], i) => {
            const point = mapPoint({ latitudeDeg, longitudeDeg });
            const [x, y] = [point[0] - turn, point[1]];
            if (i === 0) path.moveTo(x, y);
            else path.lineTo(x, y);
        });
    }
    return path;
}

export function mapPaths(answer: MapAnswer): MapPaths {
    const of = (kind: string) => answer.lines.filter((line) => line.kind === kind);
    const areas = (kind: string) => pathOf(of(kind).map((line) => line.points));
    const borders = (kind: string) => pathOf(of(kind).flatMap(withoutCuts));
    return {
        areas: { land: areas('coast'), lakes: areas('lake') },
        lines: [
            { path: borders('county'), color: color(shades.county), width: 0.6 },
            { path: borders('highway'), color: color(shades.highway), width: 0.6 },
            { path: borders('interstate'), color: color(shades.interstate), width: 1 },
            { path: borders('lake'), color: color(shades.lake), width: 0.8 },
            { path: borders('state'), color: color([...shades.state.slice(0, 3), 150]), width: 0.9 },
            { path: borders('country'), color: color(shades.country), width: 1.2 },
            { path: borders('coast'), color: color(shades.coast), width: 1.1 },
        ],
        cities: answer.cities,
    };
}

export interface Outline {
    domain: string;
    places: Place[];
}

export interface StartScene {
    view: MapView; // in pixels of the page
    map: MapPaths | null; // null until the lines have come
    pictures: (Picture & { outline: Outline; within: Rect })[];
    outlines: Outline[];
    stations: StationPlace[];
    chosen: string | null; // station or domain under the pointer, or chosen by keys
    box: [Pixel, Pixel] | null;
    boxed: Set<string>; // stations in the box
    covered: Rect[]; // parts of the map that the page covers
}

export const pixelsOf = (view: MapView, { places }: Outline): Pixel[] => {
    // Take the copies of all corners that are nearest to the first corner, so that the outline is in one piece.
    const points = places.map(mapPoint);
    const first = points[0] ? nearestCopy(points[0], view.center) : ([0, 0] as [number, number]);
    return points.map((point) => {
        const [x, y] = nearestCopy(point, first);
        return [
            (x - view.center[0]) * view.scale + view.width / 2,
            (y - view.center[1]) * view.scale + view.height / 2,
        ];
    });
};

function trace(pen: CanvasRenderingContext2D, pixels: Pixel[]): void {
    pen.beginPath();
    pixels.forEach(([x, y], i) => (i === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    pen.closePath();
}

// Calls `draw` once for each copy of the earth in the view, with the pen in the coordinates of map/mercator.ts.
function onEarths(pen: CanvasRenderingContext2D, view: MapView, draw: () => void): void {
    const half = view.width / 2 / view.scale;
    for (let copy = Math.floor(view.center[0] - half); copy <= Math.floor(view.center[0] + half); ++copy) {
        pen.save();
        pen.translate(view.width / 2, view.height / 2);
        pen.scale(view.scale, view.scale);
        pen.translate(copy - view.center[0], -view.center[1]);
        draw();
        pen.restore();
    }
}

function drawLand(pen: CanvasRenderingContext2D, { view, map }: StartScene): void {
    if (!map) return;
    onEarths(pen, view, () => {
        // Add a stroke, which hides the seams between the pieces of an area.
        pen.lineWidth = 0.7 / view.scale;
        pen.fillStyle = pen.strokeStyle = land;
        pen.fill(map.areas.land);
        pen.stroke(map.areas.land);
        pen.fillStyle = pen.strokeStyle = sea;
        pen.fill(map.areas.lakes);
    });
}

function drawPictures(pen: CanvasRenderingContext2D, scene: StartScene, tiles: Tiles): void {
    const shown: Tile[] = tilesOf(scene.view);
    tiles.begin();
    for (const picture of scene.pictures) {
        pen.save();
        trace(pen, pixelsOf(scene.view, picture.outline));
        pen.clip();
        for (const tile of shown) {
            const rect = { left: tile.x, top: tile.y, right: tile.x + tile.side, bottom: tile.y + tile.side };
            if (overlaps(rect, picture.within)) tiles.draw(pen, picture, tile);
        }
        pen.restore();
    }
}

function drawLines(pen: CanvasRenderingContext2D, { view, map }: StartScene): void {
    if (!map) return;
    onEarths(pen, view, () => {
        for (const { path, color: ink, width } of map.lines) {
            pen.strokeStyle = ink;
            pen.lineWidth = width / view.scale;
            pen.stroke(path);
        }
    });
}

function drawOutlines(pen: CanvasRenderingContext2D, scene: StartScene, taken: Rect[]): void {
    for (const outline of scene.outlines) {
        const pixels = pixelsOf(scene.view, outline);
        const isChosen = scene.chosen === outline.domain;
        trace(pen, pixels);
        pen.strokeStyle = isChosen ? accent : color(shades.border);
        pen.lineWidth = isChosen ? 2.5 : 1.5;
        pen.stroke();
        const top = pixels.reduce((best, one) => (one[1] < best[1] ? one : best), pixels[0]!);
        const middle = pixels.reduce((sum, [x]) => sum + x, 0) / pixels.length;
        pen.font = fontOf(13, 'bold');
        const wide = pen.measureText(outline.domain).width;
        const [x, y] = [middle - wide / 2, Math.max(14, top[1] + 12)];
        taken.push({ left: x - 3, top: y - 9, right: x + wide + 3, bottom: y + 9 });
        pen.textBaseline = 'middle';
        haloed(pen, outline.domain, x, y, isChosen ? accent : shades.text);
    }
}

// Draws a station: bright if its newest grid is new, gray if it is old, and hollow without a grid.
function drawDot(pen: CanvasRenderingContext2D, [x, y]: Pixel, station: StationPlace, isMarked: boolean): void {
    const isFresh = station.ageS !== null && station.ageS < freshS && !isAhead(station.ageS);
    pen.beginPath();
    pen.arc(x, y, isMarked ? 6.5 : 4.5, 0, 2 * Math.PI);
    pen.fillStyle = !station.hasGrids ? shades.halo : isFresh ? '#8fe3a8' : '#c3ccd8';
    pen.strokeStyle = isMarked ? accent : station.hasGrids ? shades.halo : shades.quietText;
    pen.lineWidth = isMarked ? 3 : 1.6;
    pen.fill();
    pen.stroke();
}

function drawStations(pen: CanvasRenderingContext2D, scene: StartScene, taken: Rect[]): void {
    const seen = scene.stations
        .map((station) => ({
            station,
            at: pixelOf(scene.view, mapPoint(station)),
            isMarked: scene.chosen === station.icao || scene.boxed.has(station.icao),
        }))
        .filter(({ at: [x, y] }) => x > -20 && y > -20 && x < scene.view.width + 20 && y < scene.view.height + 20)
        .sort(
            (a, b) =>
                Number(a.isMarked) - Number(b.isMarked) || Number(a.station.hasGrids) - Number(b.station.hasGrids),
        );
    for (const { station, at, isMarked } of seen) drawDot(pen, at, station, isMarked);
    pen.font = fontOf(12, 'bold');
    pen.textBaseline = 'middle';
    for (const {
        station,
        at: [x, y],
        isMarked,
    } of seen.reverse()) {
        const wide = pen.measureText(station.icao).width;
        const rect: Rect = { left: x - 7, top: y - 8, right: x + 11 + wide, bottom: y + 8 };
        if (!isMarked && taken.some((other) => overlaps(rect, other))) continue;
        taken.push(rect);
        haloed(pen, station.icao, x + 9, y, isMarked ? accent : station.hasGrids ? '#ffffff' : shades.quietText);
    }
}

const leastScaleOfCities = 4000;

function drawCities(pen: CanvasRenderingContext2D, { view, map }: StartScene, taken: Rect[]): void {
    if (!map || view.scale < leastScaleOfCities) return;
    let left = Math.round((view.width * view.height) / 30000);
    pen.font = fontOf(11);
    for (const city of map.cities) {
        if (left === 0) break;
        const [x, y] = pixelOf(view, mapPoint({ latitudeDeg: city.place[1], longitudeDeg: city.place[0] }));
        if (x < 4 || y < 8 || x > view.width - 4 || y > view.height - 8) continue;
        const rect: Rect = { left: x - 4, top: y - 8, right: x + 8 + pen.measureText(city.name).width, bottom: y + 8 };
        if (taken.some((other) => overlaps(rect, other))) continue;
        taken.push(rect);
        pen.fillStyle = shades.quietText;
        pen.fillRect(x - 1.5, y - 1.5, 3, 3);
        haloed(pen, city.name, x + 5, y, shades.quietText);
        --left;
    }
}

// Returns the scene in larger pixels, for large screens, on which texts are larger.
function inLargerPixels(scene: StartScene, scale: number): StartScene {
    const { view, box, covered } = scene;
    const pixel = ([x, y]: Pixel): Pixel => [x / scale, y / scale];
    return {
        ...scene,
        view: { ...view, scale: view.scale / scale, width: view.width / scale, height: view.height / scale },
        box: box && [pixel(box[0]), pixel(box[1])],
        covered: covered.map(({ left, top, right, bottom }) => ({
            left: left / scale,
            top: top / scale,
            right: right / scale,
            bottom: bottom / scale,
        })),
    };
}

export function paint(pen: CanvasRenderingContext2D, given: StartScene, tiles: Tiles, pixelRatio: number): void {
    pen.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
    pen.fillStyle = sea;
    pen.fillRect(0, 0, given.view.width, given.view.height);
    drawLand(pen, given);
    drawPictures(pen, given, tiles);
    const larger = textScale();
    const scene = inLargerPixels(given, larger);
    pen.scale(larger, larger);
    drawLines(pen, scene);
    const taken = [...scene.covered];
    drawOutlines(pen, scene, taken);
    drawStations(pen, scene, taken);
    drawCities(pen, scene, taken);
    if (!scene.box) return;
    const [[ax, ay], [bx, by]] = scene.box;
    pen.fillStyle = 'rgba(125, 184, 240, 0.12)';
    pen.strokeStyle = accent;
    pen.lineWidth = 1.5;
    pen.fillRect(ax, ay, bx - ax, by - ay);
    pen.strokeRect(ax, ay, bx - ax, by - ay);
}
