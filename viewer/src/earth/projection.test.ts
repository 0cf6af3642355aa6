import assert from 'node:assert/strict';
import test from 'node:test';

import { cellSizeM, destination, geodesic, planeOf, projectionNamed } from './projection';
import { projections } from '../facts';
import { GridPlace } from '../wire/packed_grid';
import { placeAbout } from '../testing/written_grid';

const radians = Math.PI / 180;
const grid: GridPlace = { ...placeAbout([35.3331, -97.2777]), parallelsDeg: [30, 45] };

test('a geodesic has the length of the meridian and of the equator', () => {
    // WGS84: a quarter of a meridian is 10,001,965.729 m.
    assert(
        Math.abs(
            geodesic({ latitudeDeg: 0, longitudeDeg: 10 }, { latitudeDeg: 90, longitudeDeg: 10 }).distanceM -
                10001965.729,
        ) < 0.01,
    );
    assert(
        Math.abs(
            geodesic({ latitudeDeg: 0, longitudeDeg: 0 }, { latitudeDeg: 0, longitudeDeg: 1 }).distanceM -
                6378137 * radians,
        ) < 1e-4,
    );
});

// Compares with the usual example of Vincenty's formulas, from Flinders Peak to Buninyong. The example is on GRS80,
// which differs from WGS84 by micrometers here.
test('a geodesic agrees with the published example', () => {
    const flinders = { latitudeDeg: -(37 + 57 / 60 + 3.7203 / 3600), longitudeDeg: 144 + 25 / 60 + 29.5244 / 3600 };
    const buninyong = { latitudeDeg: -(37 + 39 / 60 + 10.1561 / 3600), longitudeDeg: 143 + 55 / 60 + 35.3839 / 3600 };
    const { distanceM, azimuth } = geodesic(flinders, buninyong);
    assert(Math.abs(distanceM - 54972.271) < 0.002, `${distanceM}`);
    const degrees = (azimuth / radians + 360) % 360;
    assert(Math.abs(degrees - (306 + 52 / 60 + 5.37 / 3600)) < 2e-6, `${degrees}`);
    const there = destination(flinders, azimuth, distanceM);
    assert(Math.abs(there.latitudeDeg - buninyong.latitudeDeg) < 1e-9);
    assert(Math.abs(there.longitudeDeg - buninyong.longitudeDeg) < 1e-9);
});

test('destination and geodesic undo each other', () => {
    const from = { latitudeDeg: 35.3331, longitudeDeg: -97.2777 };
    for (let azimuth = 0; azimuth < 360; azimuth += 17) {
        for (const distance of [1, 1000, 230000, 460000]) {
            const way = geodesic(from, destination(from, azimuth * radians, distance));
            assert(Math.abs(way.distanceM - distance) < 1e-3);
            assert(
                Math.abs(((((way.azimuth / radians - azimuth) % 360) + 540) % 360) - 180) * radians * distance < 1e-2,
            );
        }
    }
});

test('every projection and its inverse return to the same place, off its center too', () => {
    for (const projection of [0, 1, 2]) {
        const plane = planeOf({
            ...grid,
            projection,
            spacing: projection === 1 ? 0.01 : 1000,
            offsetCells: [12.5, -40],
        });
        for (const [x, y] of [
            [0, 0],
            [200000, -130000],
            [-229000, 229000],
        ] as const) {
            const back = plane.toPlane(plane.toPlace([x, y]))!;
            assert(Math.hypot(back[0] - x, back[1] - y) < 1e-2, `${projection}: ${back}`);
        }
    }
});

test('an offset moves the center out of the middle', () => {
    const at = planeOf({ ...grid, offsetCells: [10, -20] }).toPlane({ latitudeDeg: 35.3331, longitudeDeg: -97.2777 })!;
    assert(Math.hypot(at[0] + 10000, at[1] - 20000) < 1e-3);
});

test('a conic is true to scale along its parallels', () => {
    const plane = planeOf({
        ...grid,
        projection: projections.lambert_conformal.number,
        centerDeg: [38, -97],
        parallelsDeg: [30, 45],
    });
    for (const latitudeDeg of [30, 45]) {
        const [a, b] = [-97, -96.999].map((longitudeDeg) => plane.toPlane({ latitudeDeg, longitudeDeg })!) as [
            [number, number],
            [number, number],
        ];
        const along = geodesic({ latitudeDeg, longitudeDeg: -97 }, { latitudeDeg, longitudeDeg: -96.999 }).distanceM;
        assert(Math.abs(Math.hypot(b[0] - a[0], b[1] - a[1]) / along - 1) < 1e-6);
    }
});

test('cells in degrees are drawn with the size that they have at the center', () => {
    const [east, north] = cellSizeM({
        ...grid,
        projection: projections.latitude_longitude.number,
        centerDeg: [0, 0],
        spacing: 0.01,
    });
    assert(Math.abs(east - 6378137 * 0.01 * radians) < 1e-6);
    assert(Math.abs(north - 6378137 * (1 - 0.00669437999014) * 0.01 * radians) < 1e-5);
});

test('a projection that the page does not know is an error', () => {
    assert.throws(() => cellSizeM({ ...grid, projection: 9 }), /9: no such projection/);
    assert.throws(() => planeOf({ ...grid, projection: 9 }), /9: no such projection/);
    for (const name of ['mercator', 'constructor'])
        assert.throws(() => projectionNamed(name), new RegExp(`${name}: no such projection`));
    assert.equal(projectionNamed('lambert_conformal'), projections.lambert_conformal.number);
});
