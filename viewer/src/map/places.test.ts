import assert from 'node:assert/strict';
import test from 'node:test';

import { circleOf, outlineOf } from './outline';
import { isInside, nearestPixel, pixelToward, search, stationPlaces } from './places';
import { geodesic } from '../earth/projection';
import { City, GridFacts, Station } from '../wire/api';

const made = (
    station: string,
    name: string,
    state: string,
    latitude_deg: number,
    longitude_deg: number,
    moments = ['REF'],
): Station => ({
    station,
    name,
    state,
    latitude_deg,
    longitude_deg,
    newest_volume: { time: '2024-01-01T00:00:00Z', age_s: 90 },
    newest_grid: moments.length > 0 ? { time: '2024-01-01T00:00:00Z', age_s: 120 } : null,
    moments,
});
const stations = stationPlaces([
    made('KTLX', 'Oklahoma City', 'OK', 35.33, -97.28),
    made('KINX', 'Tulsa', 'OK', 36.18, -95.56),
    made('KLBB', 'Lubbock', 'TX', 33.65, -101.81),
    made('TOKC', 'Oklahoma City', 'OK', 35.28, -97.51, []),
]);
const cities: City[] = [
    { name: 'Norman', population: 110000, place: [-97.44, 35.22] },
    { name: 'Nunez', population: 20000, place: [-97.3, 35.4] },
    { name: 'San José', population: 340000, place: [-84.08, 9.93] },
];
const names = (text: string): string[] => search(stations, cities, text).map((one) => one.station.icao);

test('stations become places, except stations without a position', () => {
    assert.equal(stationPlaces([{ station: 'XXXX', newest_volume: null, newest_grid: null, moments: [] }]).length, 0);
    assert.deepEqual([stations[0]!.ageS, stations[3]!.ageS, stations[3]!.hasGrids], [120, 90, false]);
});

test('a search finds stations by ICAO, by town, and near a city', () => {
    assert.deepEqual(names(''), ['KTLX', 'KINX', 'KLBB', 'TOKC']);
    assert.deepEqual(names('klbb'), ['KLBB']);
    assert.deepEqual(names('tlx'), ['KTLX']);
    assert.deepEqual(names('oklahoma'), ['KTLX', 'TOKC']);
    assert.deepEqual(names('Norman'), ['TOKC', 'KTLX', 'KINX']);
    const [first] = search(stations, cities, 'norman');
    assert.ok(first!.near === 'Norman' && first!.distanceM < 20000);
    assert.deepEqual(names('san jose'), [], 'no radar sees San José');
    assert.deepEqual(names('nuñez'), ['KTLX', 'TOKC', 'KINX'], 'accents do not matter');
    assert.deepEqual(names('qqq'), []);
});

test('a search finds the radars near coordinates', () => {
    assert.deepEqual(names('35.28, -97.51'), ['TOKC', 'KTLX', 'KINX']);
    assert.deepEqual(names('33.6 -101.8'), ['KLBB', 'TOKC', 'KTLX']);
    assert.equal(search(stations, cities, ' 35.28,-97.51')[0]!.near, '35.28,-97.51');
    for (const text of ['95, 0', '35', '35,', '10, 10']) assert.deepEqual(names(text), []);
});

test('a pointer chooses the nearest station within reach', () => {
    const pixels: [number, number][] = [
        [10, 10],
        [50, 10],
        [10, 60],
    ];
    assert.equal(nearestPixel(pixels, 40, 12, 30), 1);
    assert.equal(nearestPixel(pixels, 200, 200, 30), -1);
});

test('an arrow key leads to the next station in its direction', () => {
    const pixels: [number, number][] = [
        [10, 10],
        [50, 14],
        [90, 10],
        [12, 60],
    ];
    assert.equal(pixelToward(pixels, pixels[0]!, [1, 0]), 1);
    assert.equal(pixelToward(pixels, pixels[1]!, [1, 0]), 2);
    assert.equal(pixelToward(pixels, pixels[0]!, [0, 1]), 3);
    assert.equal(pixelToward(pixels, pixels[0]!, [-1, 0]), -1);
});

test('outlines follow the border of the grid', () => {
    const facts: GridFacts = {
        id: '',
        time: '',
        projection: 'azimuthal_equidistant',
        center: [35, -97],
        spacing_m: 1000,
        offset_cells: [0, 0],
        nx: 460,
        ny: 400,
        greatest: null,
        provenance: { source_files: [], stations: [], predicted_error: '', radar_troubles: [], sweeps: [] },
        audit: null,
    };
    const center = { latitudeDeg: 35, longitudeDeg: -97 };
    for (const place of circleOf(facts)) assert.ok(Math.abs(geodesic(center, place).distanceM - 200000) < 1);
    const corners = outlineOf(facts).filter((_, i) => i % 16 === 0);
    assert.equal(corners.length, 4);
    for (const place of corners)
        assert.ok(Math.abs(geodesic(center, place).distanceM - Math.hypot(230000, 200000)) < 1);
    const degrees: GridFacts = { ...facts, projection: 'latitude_longitude', spacing_deg: 0.01, nx: 200, ny: 100 };
    delete degrees.spacing_m;
    const box = outlineOf(degrees);
    assert.ok(Math.abs(Math.min(...box.map((one) => one.longitudeDeg)) + 98) < 1e-9);
    assert.ok(Math.abs(Math.max(...box.map((one) => one.latitudeDeg)) - 35.5) < 1e-9);
    const polygon = box.map((one) => [one.longitudeDeg, one.latitudeDeg] as [number, number]);
    assert.ok(isInside(polygon, -97.5, 35.2) && !isInside(polygon, -99, 35.2));
});
