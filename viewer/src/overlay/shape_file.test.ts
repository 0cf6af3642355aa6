// The cases are those of tests/render/shape_file_test.cpp.
import assert from 'node:assert/strict';
import test from 'node:test';

import { shapesOfGeojson } from './geojson_shapes';
import { shapesOfText } from './shape_file';
import { Shapes, isInForce, shownText } from './shapes';

const utc = (text: string): number => Date.parse(text);
const reasonOf = (text: string): string => {
    try {
        shapesOfText(text);
    } catch (error) {
        return (error as Error).message;
    }
    return '';
};
const expectReason = (text: string, reason: string): void => {
    assert.ok(reasonOf(text).includes(reason), `${text}: ${reasonOf(text)}`);
};

// The properties of a warning as the National Weather Service sends it.
const warning = `{"type": "FeatureCollection", "features": [
  {"type": "Feature",
   "properties": {"event": "Tornado Warning", "onset": "2016-06-01T10:02:00-05:00",
                  "ends": null, "expires": "2016-06-01T10:45:00-05:00"},
   "geometry": {"type": "Polygon", "coordinates":
     [[[-102, 33], [-101, 33], [-101, 34], [-102, 33]]]}},
  {"type": "Feature",
   "properties": {"name": "Levelland", "marker-color": "#0f8", "stroke-width": 3},
   "geometry": {"type": "Point", "coordinates": [-102.4, 33.6, 1000]}},
  {"type": "Feature", "properties": {}, "geometry": null}]}`;

test('a warning has its times and the color of its event', () => {
    const { shapes, unknown } = shapesOfText(warning);
    assert.equal(shapes.length, 2);
    assert.equal(unknown, 1, 'a feature without a geometry');
    const area = shapes[0]!;
    assert.equal(area.places.length, 4);
    assert.deepEqual(area.places[1], { latitudeDeg: 33, longitudeDeg: -101 });
    assert.deepEqual(area.color, [255, 0, 0]);
    assert.equal(area.fromMs, utc('2016-06-01T15:02:00Z'));
    assert.equal(area.untilMs, utc('2016-06-01T15:45:00Z'));
    assert.equal(isInForce(area, utc('2016-06-01T15:01:59Z')), false);
    assert.equal(isInForce(area, utc('2016-06-01T15:02:00Z')), true);
    assert.equal(isInForce(area, utc('2016-06-01T15:45:00Z')), false);
});

test('a point has its name and style', () => {
    const town = shapesOfText(warning).shapes[1]!;
    assert.equal(town.places.length, 1);
    assert.equal(town.label, 'Levelland');
    assert.deepEqual(town.color, [0, 255, 136]);
    assert.equal(town.width, 3);
    assert.equal(isInForce(town, 0), true, 'without times it is always in force');
});

test('every geometry is read', () => {
    const count = (geometry: object) => shapesOfGeojson(geometry).shapes.length;
    const line = [
        [1, 2],
        [3, 4],
    ];
    const ring = [...line, [5, 6], [1, 2]];
    assert.equal(count({ type: 'LineString', coordinates: line }), 1);
    assert.equal(count({ type: 'MultiPoint', coordinates: line }), 2);
    assert.equal(count({ type: 'MultiLineString', coordinates: [line, line] }), 2);
    assert.equal(count({ type: 'MultiPolygon', coordinates: [[ring], [ring]] }), 2);
    assert.equal(
        count({
            type: 'GeometryCollection',
            geometries: [
                { type: 'Point', coordinates: [1, 2] },
                { type: 'LineString', coordinates: line },
            ],
        }),
        2,
    );
    assert.equal(count({ type: 'Point', coordinates: [] }), 0);
});

test('damage of GeoJSON is named with its feature', () => {
    expectReason('{', 'no valid JSON');
    expectReason('{"type": "Topology"}', "'Topology' is no geometry");
    expectReason('{"type": "FeatureCollection"}', 'no features');
    expectReason('{"type": "Point", "coordinates": [-97, 135]}', '135, -97 is no place');
    expectReason('{"type": "Point", "coordinates": ["a", 1]}', 'two numbers');
    expectReason('{"type": "Point", "coordinates": [[1, 2]]}', 'two numbers');
    expectReason('{"type": "Feature", "properties": {"expires": "soon"}}', "'soon' is no time");
    expectReason('{"type": "Feature", "properties": {"expires": "-1h"}}', "'-1h' is no time");
    expectReason('{"type": "Feature", "properties": {"stroke": "#12345"}}', "'#12345' is no color");
    expectReason(
        '{"type": "FeatureCollection", "features": [{"type": "Point", "coordinates": [1, 2]}, 3]}',
        'feature 1',
    );
    expectReason(
        '{"type": "GeometryCollection", "geometries": [{"type": "GeometryCollection", "geometries": []}]}',
        'in another one',
    );
    const deep = `${'['.repeat(50_000)}1${']'.repeat(50_000)}`;
    expectReason(`{"type": "MultiPolygon", "coordinates": ${deep}}`, 'two numbers');
});

test('a label is short and legible', () => {
    const named = (title: string) =>
        shapesOfGeojson({
            type: 'Feature',
            properties: { title },
            geometry: { type: 'Point', coordinates: [1, 2] },
        }).shapes[0]!.label;
    assert.equal(named('x'.repeat(1_000_000)), 'x'.repeat(80));
    assert.equal(named('Nu\u00f1ez \u202Eab'), 'Nu\u00f1ez \\xe2\\x80\\xaeab');
});

test('a property with the common name of a time may be anything', () => {
    const geometry = { type: 'Point', coordinates: [1, 2] };
    const { shapes } = shapesOfGeojson({ type: 'Feature', properties: { begin: 'Main St' }, geometry });
    assert.equal(shapes[0]!.fromMs, -Infinity);
});

test('an answer of the server is read', () => {
    const { shapes } = shapesOfGeojson({
        type: 'FeatureCollection',
        features: [
            {
                type: 'Feature',
                properties: { stroke: '#ffa500', 'stroke-width': 2.5, begin: '2016-06-01T15:02:00Z' },
                geometry: { type: 'LineString', coordinates: [[179, 1], [181, 1]] }, // prettier-ignore
            },
        ],
    });
    assert.deepEqual(shapes[0]!.color, [255, 165, 0]);
    assert.equal(shapes[0]!.fromMs, utc('2016-06-01T15:02:00Z'));
    assert.equal(shapes[0]!.untilMs, Infinity);
    assert.deepEqual(shapes[0]!.places[1], { latitudeDeg: 1, longitudeDeg: -179 });
});

const placefile = `; a comment
Title: Spotters
RefreshSeconds: 60
Color: 255 128 0
TimeRange: 2016-06-01T15:00:00Z 2016-06-01T16:00:00Z
Line: 4, 0, "a road, closed"
33.5, -102.0
33.6, -101.9
End:
Polygon:
33, -102
33, -101
34, -101
End:
Text: 33.7, -101.8, 1, "Lubbock, TX"
Object: 34.0, -101.5
Icon: 0, 0, 45, 1, 1, "hover"
Text: 10, 0, 1, "spotter"
Line: 1, 0
0, 0
5, 5
End:
`;

test('a placefile is read as its specification has it', () => {
    const { shapes, unknown } = shapesOfText(placefile);
    assert.equal(shapes.length, 5);
    assert.equal(unknown, 1, 'a line in an object');
    const [road, area, city, icon, spotter] = shapes as [...Shapes['shapes'], never, never, never, never, never];
    assert.equal(road!.places.length, 2);
    assert.equal(road!.width, 4);
    assert.deepEqual(road!.color, [255, 128, 0]);
    assert.equal(road!.fromMs, utc('2016-06-01T15:00:00Z'));
    assert.equal(road!.untilMs, utc('2016-06-01T16:00:00Z'));
    assert.equal(area!.places.length, 4, 'closed');
    assert.deepEqual(area!.places[3], area!.places[0]);
    assert.equal(city!.label, 'Lubbock, TX');
    assert.equal(icon!.label, '');
    assert.equal(icon!.places[0]!.latitudeDeg, 34, 'an icon is at the place of its object');
    assert.equal(spotter!.label, 'spotter');
});

test('an object goes on after a line in it', () => {
    const { shapes, unknown } = shapesOfText(`${placefile}Text: 0, 0, 1, "after"\nEnd:\nText: 35, -100, 1, "free"\n`);
    assert.equal(unknown, 1);
    assert.deepEqual(
        shapes.slice(5).map(({ label, places }) => [label, places[0]!.latitudeDeg]),
        [
            ['after', 34],
            ['free', 35],
        ],
    );
});

test('a polygon may have contours and comments', () => {
    const { shapes } = shapesOfText(
        'Polygon:\n35, -98 ; first\n35, -97\n36, -97\n35, -98\n33, -98\n33, -97\n34, -97\nEnd:\n',
    );
    assert.deepEqual(
        shapes.map(({ places }) => places.length),
        [4, 4],
        'the last contour is closed, too',
    );
});

test('damage of a placefile is named with its line', () => {
    expectReason('', 'neither GeoJSON nor placefile');
    expectReason('Title: a\nhello\n', 'line 2: it is no statement');
    expectReason('Line: 1\n33, x\nEnd:\n', "line 2: '33' does not begin");
    expectReason('Color: 1 2\n', "line 1: '1 2' is no color");
    expectReason('Color: nan 0 0\n', 'is no color');
    expectReason(`Text:${','.repeat(20_000)}`, 'line 1 is too long');
    expectReason('TimeRange: now then\n', "'now' is no time");
    expectReason('Text: 95, 0, 1, "x"\n', '95, 0 is no place');
});

test('formats are told apart by the first letter', () => {
    assert.equal(shapesOfText(`\uFEFF\n${warning}`).shapes.length, 2);
    assert.equal(shapesOfText(placefile).shapes.length, 5);
    assert.ok(/^it is no valid JSON: ./.test(reasonOf('{]')));
});

test('the panel tells how many shapes are in force', () => {
    const read = shapesOfText(warning);
    assert.equal(shownText(read, utc('2016-06-01T15:30:00Z')), '2 of 2 in force, 1 unknown');
    assert.equal(shownText(read, utc('2016-06-01T16:00:00Z')), '1 of 2 in force, 1 unknown');
    assert.equal(shownText({ ...read, unknown: 0 }, 0), '1 of 2 in force');
});
