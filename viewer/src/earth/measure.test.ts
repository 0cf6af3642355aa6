import assert from 'node:assert/strict';
import test from 'node:test';

import { areaM2, legOf } from './measure';
import { destination } from './projection';

const place = (latitudeDeg: number, longitudeDeg: number) => ({ latitudeDeg, longitudeDeg });

test('a leg is a geodesic, as the published line from JFK to LHR', () => {
    // GeographicLib's GeodSolve(1): 40.6 -73.8 to 51.6 -0.5.
    const { distanceM, azimuthDeg } = legOf(place(40.6, -73.8), place(51.6, -0.5));
    assert.ok(Math.abs(distanceM - 5551759.4) < 0.1, String(distanceM));
    assert.ok(Math.abs(azimuthDeg - 51.198882845579) < 1e-9, String(azimuthDeg));
});

test('areas are on the ellipsoid', () => {
    // The authalic latitude gives the area of a quadrangle between parallels in closed form. The quadrangle here is so
    // narrow that its northern and southern sides are nearly geodesics.
    const a = 6378137;
    const e2 = 0.0066943799901413165;
    const e = Math.sqrt(e2);
    const part = (sine: number) => (1 - e2) * (sine / (2 * (1 - e2 * sine * sine)) + Math.atanh(e * sine) / (2 * e));
    const [south, north, wide] = [35, 36, 0.01];
    const sine = (degrees: number) => Math.sin((degrees * Math.PI) / 180);
    const exact = a * a * (part(sine(north)) - part(sine(south))) * ((wide * Math.PI) / 180);
    const area = areaM2([place(south, -97), place(south, -97 + wide), place(north, -97 + wide), place(north, -97)]);
    assert.ok(Math.abs(area / exact - 1) < 1e-6, `${area} ${exact}`);
    // The area of this circle about a place is known to some 1e-5.
    const circle = Array.from({ length: 360 }, (_, i) => destination(place(40, -90), (i * Math.PI) / 180, 50000));
    const flat = 180 * 50000 ** 2 * Math.sin((2 * Math.PI) / 360);
    assert.ok(Math.abs(areaM2(circle) / flat - 1) < 3e-5, String(areaM2(circle) / flat));
});

test('neither the direction of the corners nor the antimeridian changes an area', () => {
    const corners = [place(10, 179), place(10, -179), place(12, -179), place(12, 179)];
    const shifted = corners.map((one) => place(one.latitudeDeg, one.longitudeDeg - 100));
    assert.ok(Math.abs(areaM2(corners) / areaM2(shifted) - 1) < 1e-9);
    assert.ok(Math.abs(areaM2([...corners].reverse()) / areaM2(corners) - 1) < 1e-9);
    assert.equal(areaM2(corners.slice(0, 2)), 0);
});
