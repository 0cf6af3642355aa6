import assert from 'node:assert/strict';
import test from 'node:test';

import {
    MapView,
    boxAbout,
    boxBetween,
    draggedMap,
    fittedMap,
    grownBox,
    holdsBox,
    isInBox,
    mapPoint,
    pixelOf,
    placeOfPoint,
    pointAt,
    reaches,
    scaledMap,
    tilesOf,
} from './mercator';

const view: MapView = { center: [0.25, 0.4], scale: 4096, width: 800, height: 600 };
const place = (latitudeDeg: number, longitudeDeg: number) => ({ latitudeDeg, longitudeDeg });

test('places are in the right tiles', () => {
    // An example of the OpenStreetMap wiki, "Slippy map tilenames": zoom 17.
    const [x, y] = mapPoint(place(51.51202, 0.02435));
    assert.equal(Math.floor(x * 2 ** 17), 65544);
    assert.equal(Math.floor(y * 2 ** 17), 43582);
    assert.deepEqual(mapPoint(place(0, 0)), [0.5, 0.5]);
    for (const one of [place(35.333, -97.278), place(-14.3, 170.7), place(64.5, -165.3)]) {
        const back = placeOfPoint(mapPoint(one));
        assert.ok(
            Math.abs(back.latitudeDeg - one.latitudeDeg) < 1e-9 &&
                Math.abs(back.longitudeDeg - one.longitudeDeg) < 1e-9,
        );
    }
});

test('the point under the pointer stays there while the map is scaled or dragged', () => {
    const at = pointAt(view, 100, 450);
    const [x, y] = pixelOf(scaledMap(view, 1.7, 100, 450), at);
    assert.ok(Math.hypot(x - 100, y - 450) < 1e-6);
    const [dx, dy] = pixelOf(draggedMap(view, 30, -20), at);
    assert.ok(Math.hypot(dx - 130, dy - 430) < 1e-6);
});

test('the map cannot be dragged out of sight', () => {
    let now = view;
    for (let i = 0; i < 50; ++i) now = scaledMap(draggedMap(now, 0, 900), 0.5);
    assert.ok(now.scale >= 256 && now.center[1] >= 0 && now.center[1] <= 1);
    for (let i = 0; i < 50; ++i) now = scaledMap(now, 2);
    assert.ok(now.scale <= 256 * 2 ** 13);
});

test('a fit shows every point in the part of the map that no panel covers, across the antimeridian too', () => {
    for (const places of [
        [place(35, -97), place(47, -122), place(25, -80)],
        [place(13.5, 144.8), place(21.9, -159.6)],
        [place(35, -97)],
    ]) {
        const fitted = fittedMap(places.map(mapPoint), 800, 600, [300, 60, 20, 20]);
        for (const one of places) {
            const [x, y] = pixelOf(fitted, mapPoint(one));
            assert.ok(x > 299 && x < 781 && y > 59 && y < 581, `${x} ${y}`);
        }
    }
    const [guam, kauai] = [place(13.5, 144.8), place(21.9, -159.6)].map(mapPoint);
    const across = fittedMap([guam!, kauai!], 800, 600, [0, 0, 0, 0]);
    assert.ok(pixelOf(across, guam!)[0] < pixelOf(across, kauai!)[0], 'Guam is west of Hawaii');
});

test('tiles cover the view, and no tile comes twice', () => {
    const tiles = tilesOf(view);
    assert.equal(tiles[0]!.zoom, 4);
    let area = 0;
    for (const tile of tiles) {
        const across = Math.min(800, tile.x + tile.side) - Math.max(0, tile.x);
        const down = Math.min(600, tile.y + tile.side) - Math.max(0, tile.y);
        assert.ok(across > 0 && down > 0);
        area += across * down;
        assert.ok(tile.column >= 0 && tile.column < 16 && tile.row >= 0 && tile.row < 16);
    }
    assert.ok(Math.abs(area - 800 * 600) < 1);
});

test('a box holds the places that are drawn in it', () => {
    const [x, y] = pixelOf(view, mapPoint(place(40, -90)));
    const box = boxBetween(view, [x + 50, y + 40], [x - 50, y - 40]);
    assert.ok(isInBox(place(40, -90), box));
    assert.ok(!isInBox(place(40, -60), box) && !isInBox(place(60, -90), box));
    const pacific: MapView = { ...view, center: mapPoint(place(15, 180)) };
    const wide = boxBetween(pacific, [0, 0], [800, 600]);
    assert.ok(isInBox(place(13.5, 150), wide) && isInBox(place(20, -160), wide) && !isInBox(place(15, -97), wide));
});

// 2026-11-28: with one radar west of the date line, the start map had no land east of it.
test('a box grows across the date line, and holds boxes there', () => {
    const grown = grownBox({ west: 130, south: 0, east: 230, north: 60 }, 0.5);
    assert.deepEqual(grown, { west: 80, south: -30, east: 280, north: 85 });
    assert.ok(holdsBox(grown, { west: -170, south: 0, east: -130, north: 60 }));
    assert.ok(holdsBox(grown, { west: 170, south: 0, east: 200, north: 60 }));
    assert.ok(!holdsBox(grown, { west: -90, south: 0, east: -70, north: 60 }));
    assert.ok(!holdsBox(grown, { west: 170, south: -40, east: 200, north: 60 }));
    const all = grownBox({ west: -170, south: -80, east: 160, north: 80 }, 0.5);
    assert.equal(all.east - all.west, 360);
    assert.ok(holdsBox(all, { west: -90, south: 0, east: 200, north: 60 }));
});

// 2026-11-28: a grid across 180 degrees asked for the map of the whole circle.
test('the box about a longitude is no wider than its places', () => {
    const box = boxAbout(-178, [place(50, 179), place(52, -175), place(51, -178)]);
    assert.deepEqual(box, { west: -181, south: 50, east: -175, north: 52 });
    const east = boxAbout(179, [place(50, 177), place(52, -179)]);
    assert.deepEqual(east, { west: 177, south: 50, east: 181, north: 52 });
});

test('a radar belongs to a view that its circle meets (2026-11-28: near views left out radars beside them)', () => {
    const view: MapView = {
        center: mapPoint({ latitudeDeg: 40, longitudeDeg: -100 }),
        scale: 256 * 2 ** 10,
        width: 700,
        height: 400,
    };
    assert.equal(reaches(view, { latitudeDeg: 40, longitudeDeg: -97 }, 230_000), true); // 256 km away, the view is 82 km wide
    assert.equal(reaches(view, { latitudeDeg: 40, longitudeDeg: -96 }, 230_000), false);
    assert.equal(reaches(view, { latitudeDeg: 40, longitudeDeg: -100 }, 230_000), true);
});
