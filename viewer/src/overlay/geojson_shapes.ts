// Reads shapes from GeoJSON (RFC 7946), as render/overlay/geojson_shapes.cpp does: colors and widths of simplestyle or
// of events of the National Weather Service, labels, and the times from which and until which a feature is in force.
//
// Errors: an Error with the number of the feature, from 0.

import { eventColors } from '../facts';
import { shapeColor, shapeLabel, shapePlace, shapeTime } from './shape_values';
import { Rgb, Shape, Shapes, mostShapePlaces } from './shapes';

type Style = Omit<Shape, 'places'>;
type Values = Readonly<Record<string, unknown>>;

const beginNames = ['polygon_begin', 'onset', 'issue', 'effective', 'begin'];
const endNames = ['polygon_end', 'ends', 'expire', 'expires', 'end'];
const leastWidth = 0.5;
const mostWidth = 20;
export const usualStyle: Style = { color: null, width: 2, label: '', fromMs: -Infinity, untilMs: Infinity };
export const shapeWidth = (width: number): number => Math.min(mostWidth, Math.max(leastWidth, width));

const isObject = (value: unknown): value is Values =>
    typeof value === 'object' && value !== null && !Array.isArray(value);

// Returns the first of these properties that is a text; empty if there is none.
function textOf(properties: Values, names: readonly string[]): string {
    const found = names.map((name) => properties[name]).find((one) => typeof one === 'string' && one !== '');
    return (found as string | undefined) ?? '';
}

// Returns the time of the first of these properties; `otherwise` if there is none. The last name is a common word, so
// its property may not be a time.
function timeOf(properties: Values, names: readonly string[], otherwise: number): number {
    const text = textOf(properties, names);
    if (text === '') return otherwise;
    try {
        return shapeTime(text);
    } catch (error) {
        if (text === textOf(properties, names.slice(-1))) return otherwise;
        throw error;
    }
}

function colorOf(properties: Values): Rgb | null {
    const given = textOf(properties, ['stroke', 'marker-color', 'color']);
    if (given.startsWith('#')) return shapeColor(given);
    return eventColors.find(({ event }) => event === properties['event'])?.color ?? null;
}

// Returns what all shapes of a feature share.
function styleOf({ properties }: Values): Style {
    if (!isObject(properties)) return usualStyle;
    const width = properties['stroke-width'];
    return {
        color: colorOf(properties),
        width: typeof width === 'number' ? shapeWidth(width) : usualStyle.width,
        label: shapeLabel(textOf(properties, ['title', 'name'])),
        fromMs: timeOf(properties, beginNames, usualStyle.fromMs),
        untilMs: timeOf(properties, endNames, usualStyle.untilMs),
    };
}

function fail(reason: string): never {
    throw new Error(reason);
}

const typeOf = (value: unknown): string => (isObject(value) ? textOf(value, ['type']) : '');

// Levels of lists about the positions of a geometry.
const depths: Readonly<Record<string, number>> = {
    Point: 0,
    LineString: 1,
    MultiPoint: 1,
    Polygon: 2,
    MultiLineString: 2,
    MultiPolygon: 3,
};

class GeoJsonReader {
    readonly taken: Shapes = { shapes: [], unknown: 0 };
    private places = 0;

    read(value: unknown): void {
        if (!isObject(value)) fail('it is no object of GeoJSON');
        if (typeOf(value) !== 'FeatureCollection') return this.readFeature(value);
        const { features } = value;
        if (!Array.isArray(features)) fail('its FeatureCollection has no features');
        features.forEach((feature, number) => {
            try {
                this.readFeature(feature);
            } catch (error) {
                fail(`feature ${number}: ${error instanceof Error ? error.message : String(error)}`);
            }
        });
    }

    private readFeature(feature: unknown): void {
        if (!isObject(feature) || typeOf(feature) !== 'Feature') return this.readGeometry(feature, usualStyle);
        const style = styleOf(feature);
        if (feature['geometry'] == null) ++this.taken.unknown;
        else this.readGeometry(feature['geometry'], style);
    }

    private readGeometry(geometry: unknown, style: Style): void {
        const type = typeOf(geometry);
        const { geometries, coordinates } = isObject(geometry) ? geometry : ({} as Values);
        if (type === 'GeometryCollection') {
            if (!Array.isArray(geometries)) fail('it has no geometries');
            for (const part of geometries as unknown[]) {
                if (typeOf(part) === 'GeometryCollection') fail('a GeometryCollection is in another one');
                this.readGeometry(part, style);
            }
            return;
        }
        const depth = depths[type] ?? fail(`'${type}' is no geometry of GeoJSON`);
        if (coordinates === undefined) fail('it has no coordinates');
        this.readPlaces(coordinates, depth, type.endsWith('Point'), style);
    }

    // Reads a position, or lists in lists of positions. If `arePoints`, each position is a shape; otherwise each
    // innermost list is a shape.
    private readPlaces(value: unknown, depth: number, arePoints: boolean, style: Style): void {
        if (!Array.isArray(value)) fail('its coordinates are no list');
        const list = value as unknown[];
        if (arePoints && depth === 0) {
            // An empty geometry counts as a missing geometry.
            if (list.length > 0) this.taken.shapes.push({ ...style, places: [this.placeOf(list)] });
        } else if (depth === 1 && !arePoints) {
            const places = list.map((one) => this.placeOf(one));
            if (places.length > 1) this.taken.shapes.push({ ...style, label: '', places });
        } else {
            for (const part of list) this.readPlaces(part, depth - 1, arePoints, style);
        }
    }

    private placeOf(value: unknown): Shape['places'][number] {
        const [longitudeDeg, latitudeDeg] = Array.isArray(value) ? (value as unknown[]) : [];
        if (typeof longitudeDeg !== 'number' || typeof latitudeDeg !== 'number')
            fail('a position is no list of two numbers');
        if (++this.places > mostShapePlaces) fail(`it has more than ${mostShapePlaces} points`);
        return shapePlace(latitudeDeg, longitudeDeg);
    }
}

export function shapesOfGeojson(value: unknown): Shapes {
    const reader = new GeoJsonReader();
    reader.read(value);
    return reader.taken;
}
