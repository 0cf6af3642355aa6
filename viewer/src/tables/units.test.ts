import assert from 'node:assert/strict';
import test from 'node:test';

import {
    distanceText,
    heightText,
    knownUnits,
    namesOf,
    ringSpacingM,
    shownUnit,
    unitsOf,
    usualUnits,
    valueText,
} from './units';

const american = unitsOf('kft,knots,miles');

test('units are named in any order, and unknown names are ignored', () => {
    assert.equal(american.speed.symbol, 'kt');
    assert.equal(american.distance.symbol, 'mi');
    assert.equal(american.height.symbol, 'kft');
    assert.deepEqual(unitsOf('<script>,,furlongs'), usualUnits);
    assert.deepEqual(unitsOf(''), usualUnits);
});

test('the names of each choice of units give the same choice', () => {
    for (const speed of knownUnits.speed) {
        for (const distance of knownUnits.distance) {
            for (const height of knownUnits.height)
                assert.deepEqual(unitsOf(namesOf({ speed, distance, height })), { speed, distance, height });
        }
    }
    assert.equal(namesOf(usualUnits), '', 'the usual units need no name');
});

test('heights, distances and speeds are converted', () => {
    assert.equal(heightText(12345, usualUnits), '12.3 km');
    assert.equal(heightText(12192, american), '40.0 kft');
    assert.equal(heightText(12192, unitsOf('feet')), '40000 ft');
    assert.equal(heightText(1000, unitsOf('feet')), '3300 ft', 'a cell is no hundred feet high');
    assert.equal(distanceText(160934.4, american), '100.0 mi');
    assert.equal(distanceText(185200, unitsOf('nautical-miles')), '100.0 nmi');
    assert.equal(valueText(-25.5, 'm/s', american), '-49.6 kt');
    assert.equal(valueText(10, 'm/s', unitsOf('mph')), '22.4 mph');
    assert.equal(valueText(10, 'm/s', unitsOf('km/h')), '36 km/h');
    assert.equal(valueText(-0.5, 'm/s', usualUnits), '-0.5 m/s');
});

test('values that are no speeds are not converted', () => {
    assert.equal(valueText(52.5, 'dBZ', american), '52.5 dBZ');
    assert.equal(valueText(0.973, '1', american, 3), '0.973');
    assert.deepEqual(shownUnit('dB', american), { symbol: 'dB', perStored: 1 });
});

test('rings are at round numbers of the chosen unit', () => {
    assert.equal(ringSpacingM(460e3, usualUnits), 200e3);
    assert.equal(ringSpacingM(230e3, usualUnits), 100e3);
    assert.equal(ringSpacingM(230e3, american) / 1609.344, 50);
    assert.equal(ringSpacingM(1e9, usualUnits), 1e6);
});
