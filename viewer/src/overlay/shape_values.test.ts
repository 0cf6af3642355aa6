import assert from 'node:assert/strict';
import test from 'node:test';

import { shapeColor, shapePlace, shapeTime } from './shape_values';

test('times have zones or are UTC', () => {
    const noon = Date.UTC(2016, 5, 1, 12);
    for (const text of [
        '2016-06-01T12:00:00Z',
        '2016-06-01 12:00',
        '2016-06-01T12:00:00.000',
        '2016-06-01T07:00:00-05:00',
        '2016-06-01T21:30+0930',
        '201606011200',
        '20160601_120000',
    ])
        assert.equal(shapeTime(text), noon, text);
    assert.equal(shapeTime('2016-06-01T12:00:00.5999Z'), noon + 599);
    assert.equal(shapeTime('2016-02-29'), Date.UTC(2016, 1, 29));
});

test('other texts are no times', () => {
    for (const text of [
        '',
        'now',
        '-1h',
        '2016',
        '2015-02-29',
        '2016-13-01',
        '2016-06-01T24:00',
        '2016-06-01T12',
        '2016-00-10',
    ])
        assert.throws(() => shapeTime(text), new RegExp(`'${text}' is no time`));
});

test('colors have three or six digits', () => {
    assert.deepEqual(shapeColor('#f80'), [255, 136, 0]);
    assert.deepEqual(shapeColor('#Ff8800'), [255, 136, 0]);
    for (const text of ['#ff880', 'ff8800', '#gg8800', '#ff8800ff'])
        assert.throws(() => shapeColor(text), / is no color such as #ff8800/);
});

test('places are on the earth', () => {
    assert.deepEqual(shapePlace(-90, 190), { latitudeDeg: -90, longitudeDeg: -170 });
    assert.deepEqual(shapePlace(10, -200), { latitudeDeg: 10, longitudeDeg: 160 });
    assert.throws(() => shapePlace(91, 0), /91, 0 is no place/);
    assert.throws(() => shapePlace(NaN, 0), /is no place/);
    assert.throws(() => shapePlace(0, 361), /0, 361 is no place/);
});
