// Reads shapes from placefiles of GRLevelX, as render/overlay/placefile_shapes.cpp does: Line, Polygon, Text, Place and
// Icon (a point), also in an Object, with Color and TimeRange.
//
// Errors: an Error with the number of the line, from 1.

import { Place } from '../earth/projection';
import { shapeWidth, usualStyle } from './geojson_shapes';
import { shapeLabel, shapePlace, shapeTime } from './shape_values';
import { Shape, Shapes, mostShapePlaces } from './shapes';

const longestLine = 10_000;

// Splits a line at commas that are not inside quotes, and removes the quotes.
function fieldsOf(text: string): string[] {
    const fields = [''];
    let isQuoted = false;
    for (const letter of text) {
        if (letter === '"') isQuoted = !isQuoted;
        else if (letter === ',' && !isQuoted) fields.push('');
        else fields[fields.length - 1] += letter;
    }
    return fields.map((field) => field.trim());
}

const numberOf = (text: string | undefined): number =>
    text !== undefined && /^-?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : NaN;

function isClosed({ places }: Shape): boolean {
    const [first, last] = [places[0]!, places[places.length - 1]!];
    return first.latitudeDeg === last.latitudeDeg && first.longitudeDeg === last.longitudeDeg;
}

class PlacefileReader {
    readonly taken: Shapes = { shapes: [], unknown: 0 };
    private places = 0;
    private statements = 0;
    private style = { ...usualStyle };
    private line: Shape | null = null; // of the current Line or Polygon
    private isArea = false; // true for a Polygon
    private object: Place | null = null; // place of the current Object
    private isUnknown = false; // the current block cannot be drawn

    read(text: string): void {
        text.split('\n').forEach((line, i) => {
            if (line.length > longestLine) throw new Error(`line ${i + 1} is too long`);
            try {
                this.takeLine(line.trim());
            } catch (error) {
                throw new Error(`line ${i + 1}: ${error instanceof Error ? error.message : String(error)}`);
            }
        });
        if (this.statements === 0) throw new Error('it is neither GeoJSON nor placefile');
        this.endBlock();
    }

    private takeLine(line: string): void {
        if (line === '' || line.startsWith(';')) return;
        const statement = /^([a-z]*):(.*)$/i.exec(line);
        if (statement) this.takeStatement(statement[1]!, statement[2]!.trim());
        else if (this.line) this.takePlace(this.line, line);
        else if (!this.isUnknown && !this.object) throw new Error('it is no statement');
    }

    private takePlace(line: Shape, text: string): void {
        line.places.push(this.placeOf(text.replace(/;.*/, '').trim()));
        // A polygon may have several contours. Each ends where it begins.
        if (this.isArea && line.places.length > 2 && isClosed(line)) this.endLine(line);
    }

    private takeStatement(name: string, value: string): void {
        ++this.statements;
        switch (name) {
            case 'End':
                // A Line in an Object has an End of its own.
                if (!(this.object && this.isUnknown)) return this.endBlock();
                this.isUnknown = false;
                return;
            case 'Color':
                return this.takeColor(value);
            case 'TimeRange':
                return this.takeTimes(value);
            case 'Text':
            case 'Place':
            case 'Icon':
                return this.takePoint(name, value);
            case 'Object':
                this.endBlock();
                this.object = this.placeOf(value);
                return;
            case 'Line':
            case 'Polygon':
            case 'Triangles':
            case 'Image':
                return this.beginBlock(name, value);
            default: // titles, fonts, refresh times and the like
        }
    }

    private beginBlock(name: string, value: string): void {
        const isInObject = this.object !== null;
        if (!isInObject) this.endBlock();
        if (isInObject || (name !== 'Line' && name !== 'Polygon')) {
            ++this.taken.unknown;
            this.isUnknown = true;
            return;
        }
        const width = numberOf(fieldsOf(value)[0]);
        this.isArea = name === 'Polygon';
        this.line = { ...this.style, places: [] };
        if (!this.isArea && !Number.isNaN(width)) this.line.width = shapeWidth(width);
    }

    private takeColor(value: string): void {
        const levels = value.split(/[\s,]+/).map(numberOf);
        const [red = NaN, green = NaN, blue = NaN] = levels;
        if (![red, green, blue].every((one) => one >= 0 && one <= 255))
            throw new Error(`'${value}' is no color such as 255 0 0`);
        this.style.color = [Math.floor(red), Math.floor(green), Math.floor(blue)];
    }

    private takeTimes(value: string): void {
        const [from = '', ...until] = value.split(' ');
        const fromMs = shapeTime(from);
        this.style = { ...this.style, fromMs, untilMs: shapeTime(until.join(' ').trim()) };
    }

    private placeOf(text: string): Place {
        const [latitude = '', longitude] = fieldsOf(text);
        const [latitudeDeg, longitudeDeg] = [numberOf(latitude), numberOf(longitude)];
        if (Number.isNaN(latitudeDeg) || Number.isNaN(longitudeDeg))
            throw new Error(`'${latitude}' does not begin with a latitude and a longitude`);
        if (++this.places > mostShapePlaces) throw new Error(`it has more than ${mostShapePlaces} points`);
        return shapePlace(latitudeDeg, longitudeDeg);
    }

    // Places in an Object are pixels from the place of the object.
    private takePoint(name: 'Text' | 'Place' | 'Icon', value: string): void {
        const place = this.object ?? this.placeOf(value);
        const label = name === 'Icon' ? '' : shapeLabel(fieldsOf(value)[name === 'Text' ? 3 : 2] ?? '');
        this.taken.shapes.push({ ...this.style, places: [place], label });
    }

    // Adds a line, and begins another line like it.
    private endLine(line: Shape): void {
        const { places } = line;
        if (this.isArea && places.length > 1 && !isClosed(line)) places.push(places[0]!);
        if (places.length > 1) this.taken.shapes.push(line);
        this.line = { ...line, places: [] };
    }
    private endBlock(): void {
        if (this.line) this.endLine(this.line);
        this.line = this.object = null;
        this.isUnknown = false;
    }
}

export function shapesOfPlacefile(text: string): Shapes {
    const reader = new PlacefileReader();
    reader.read(text);
    return reader.taken;
}
