// Reads color tables in TOML, whose keys docs/rendering.md and render/color/color_file.h describe.
//
// Errors: see table_file.ts. If there are several errors, reports the first line that has one.

import { Rgba } from '../wire/color_tables';
import {
    FilePoint,
    TableError,
    TableFile,
    colorOfHex,
    greatestValue,
    knownMoments,
    mostStops,
    shownWord,
} from './table_file';
import { TomlTable, readTomlValues } from './toml_values';

class TomlColors {
    private complaints: { line: number; why: string }[] = [];
    private read = new Map<TomlTable, Set<string>>();

    constructor(
        private root: TomlTable,
        private fileName: string,
    ) {}

    table(): TableFile {
        const { root } = this;
        const moment = this.moment();
        const isStepped = this.flag(root, 'stepped') ?? false;
        const rangeFolded = this.color(root, 'range_folded');
        const end = this.number(root, 'end', -greatestValue);
        const file: TableFile = {
            name: this.text(root, 'name') ?? '',
            moment,
            unit: moment === null ? (this.text(root, 'unit') ?? '') : knownMoments[moment]!,
            isStepped,
            end,
            rangeFolded,
            points: this.points(isStepped),
        };
        const last = file.points[file.points.length - 1];
        if (end !== null && last && end <= last.value)
            this.complain(root, 'end', "must be above the last point's value");
        this.finish();
        return file;
    }

    private complain(table: TomlTable, key: string, why: string): void {
        this.complaints.push({ line: table.lineOf(key), why: `${shownWord(key)} ${why}` });
    }
    private find(table: TomlTable, key: string): unknown {
        const read = this.read.get(table) ?? new Set();
        this.read.set(table, read.add(key));
        return table.get(key);
    }
    private text(table: TomlTable, key: string): string | null {
        const value = this.find(table, key);
        if (value === undefined || typeof value === 'string') return value ?? null;
        this.complain(table, key, 'must be a text');
        return null;
    }
    private flag(table: TomlTable, key: string): boolean | null {
        const value = this.find(table, key);
        if (value === undefined || typeof value === 'boolean') return value ?? null;
        this.complain(table, key, 'must be true or false');
        return null;
    }
    private number(table: TomlTable, key: string, least: number): number | null {
        const value = this.find(table, key);
        if (value === undefined) return null;
        if (typeof value === 'number' && value >= least && value <= greatestValue) return value;
        this.complain(
            table,
            key,
            typeof value === 'number' ? `is out of range: ${least} to ${greatestValue}` : 'must be a number',
        );
        return null;
    }
    private color(table: TomlTable, key: string): Rgba | null {
        const value = this.find(table, key);
        if (value === undefined) return null;
        const numbers: unknown[] = Array.isArray(value) ? value : [];
        const isColor =
            (numbers.length === 3 || numbers.length === 4) &&
            numbers.every((one) => typeof one === 'number' && one >= 0 && one <= 255);
        if (isColor) return [...(numbers as number[]).map(Math.round), 255].slice(0, 4) as Rgba;
        const color = typeof value === 'string' ? colorOfHex(value) : null;
        if (!color) this.complain(table, key, 'must be "#rrggbb", "#rrggbbaa" or three or four numbers 0 to 255');
        return color;
    }

    private moment(): string | null {
        const name = this.text(this.root, 'moment');
        const unit = this.text(this.root, 'unit');
        if (name === null) return null;
        const known = Object.prototype.hasOwnProperty.call(knownMoments, name) ? knownMoments[name]! : undefined;
        if (known === undefined)
            this.complain(this.root, 'moment', `must be one of ${Object.keys(knownMoments).join(', ')}`);
        else if (unit !== null && unit !== known) this.complain(this.root, 'unit', `of ${name} must be "${known}"`);
        return known === undefined ? null : name;
    }

    private points(isStepped: boolean): FilePoint[] {
        this.find(this.root, 'point');
        const items = this.root.tables('point');
        const least = isStepped ? 1 : 2;
        if (!items || items.length < least || items.length > mostStops) {
            this.complain(this.root, 'point', `must be there ${least} to ${mostStops} times, as [[point]]`);
            return [];
        }
        const points: FilePoint[] = [];
        for (const item of items) this.point(item, points, isStepped);
        const withOpacity = points.filter((point) => point.perKm !== null).length;
        if (withOpacity !== 0 && withOpacity !== points.length) {
            this.complain(items[0]!, 'opacity_per_km', 'must be given for all points or for none');
        }
        return points;
    }
    private point(item: TomlTable, points: FilePoint[], isStepped: boolean): void {
        const colorKey = item.has('colour') && !item.has('color') ? 'colour' : 'color';
        for (const key of ['value', colorKey]) if (!item.has(key)) this.complain(item, key, 'is missing');
        const value = this.number(item, 'value', -greatestValue);
        const color = this.color(item, colorKey);
        const until = this.color(item, 'until');
        if (until && isStepped) this.complain(item, 'until', 'has no meaning where colors are stepped');
        const perKm = this.number(item, 'opacity_per_km', 0);
        if (value === null || color === null) return;
        const before = points[points.length - 1];
        if (before && Math.fround(value) <= Math.fround(before.value))
            this.complain(item, 'value', 'must increase from point to point');
        points.push({ value, color, ...(until && { until }), perKm });
    }

    private finish(): void {
        for (const [table, read] of this.read) {
            for (const key of table.keys) if (!read.has(key)) this.complain(table, key, 'is an unknown key');
        }
        const [first] = this.complaints.sort((a, b) => a.line - b.line);
        if (first) throw new TableError(`${this.fileName}:${first.line}: ${first.why}`);
    }
}

export function readToml(text: string, fileName: string): TableFile {
    return new TomlColors(readTomlValues(text, fileName), fileName).table();
}
