// Reads TOML with smol-toml, and finds the lines of its keys, which smol-toml does not report.
//
// Errors: a TableError, "FILE:LINE: why". Values nested deeper than `deepest` are an error, so that no text exhausts
// the stack.

import { TomlError, parse } from 'smol-toml';
import { TableError, shownWord } from './table_file';

const deepest = 16;

// Line of a value, and places of its keys if it is a table, or of its items if it is an array.
interface Place {
    line: number;
    keys: Map<string, Place>;
    items: Place[];
}

const placeAt = (line: number): Place => ({ line, keys: new Map(), items: [] });

// A table of a TOML file, with the lines of its keys.
export class TomlTable {
    constructor(
        private values: Record<string, unknown>,
        private place: Place,
    ) {}

    get keys(): string[] {
        return Object.keys(this.values);
    }
    has(key: string): boolean {
        return Object.prototype.hasOwnProperty.call(this.values, key);
    }
    // Returns the value of a key as smol-toml reads it; undefined without this key.
    get(key: string): unknown {
        return this.has(key) ? this.values[key] : undefined;
    }
    // Returns the tables of an array; null if the value is not an array, or not all of its items are tables.
    tables(key: string): TomlTable[] | null {
        const items = this.get(key);
        const places = this.place.keys.get(key)?.items ?? [];
        if (!Array.isArray(items) || !items.every(isTable)) return null;
        return items.map((item, i) => new TomlTable(item, places[i] ?? this.place));
    }
    lineOf(key: string): number {
        return this.place.keys.get(key)?.line ?? this.place.line;
    }
}

const isTable = (value: unknown): value is Record<string, unknown> =>
    typeof value === 'object' && value !== null && !Array.isArray(value) && !(value instanceof Date);

// Matches a text, a comment, an end of line, a bracket, ',', '=', or a run of other characters.
const token =
    /"""(?:\\[^]|[^\\])*?"{3,5}|'''[^]*?'{3,5}|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|#.*|\n|[[\]{},=]|(?:(?!["'#\n[\]{},=])[^])+/g;

// Finds the lines of keys in a text that smol-toml accepts.
class LineFinder {
    private tokens: { text: string; line: number }[] = [];
    private at = 0;

    constructor(text: string) {
        let line = 1;
        for (const match of text.matchAll(token)) {
            const found = match[0]!;
            if (found.trim() !== '' && !found.startsWith('#')) this.tokens.push({ text: found.trim(), line });
            if (found === '\n') this.tokens.push({ text: '\n', line });
            line += found.split('\n').length - 1;
        }
    }

    find(): Place {
        const root = placeAt(1);
        let table = root;
        for (; !this.isAtEnd; ++this.at) {
            if (this.next === '\n') continue;
            if (this.next === '[') table = this.header(root);
            else this.pair(table);
        }
        return root;
    }

    private get isAtEnd(): boolean {
        return this.at >= this.tokens.length;
    }
    private get next(): string {
        return this.tokens[this.at]?.text ?? '';
    }
    private get line(): number {
        return this.tokens[this.at]?.line ?? 1;
    }

    // Reads the parts of a key, up to the token `end`.
    private key(end: string): string[] {
        let text = '';
        for (; !this.isAtEnd && this.next !== end; ++this.at) text += this.next;
        const parts = text.match(/"(?:\\.|[^"\\])*"|'[^']*'|[^.\s"']+/g) ?? [];
        return parts.map((part) => Object.keys(parse(`${part} = 0`))[0]!);
    }

    // Returns the place of a dotted key, and makes places for its parts where there are none. In an array of tables,
    // goes to the last table.
    private descend(table: Place, parts: string[], line: number): Place {
        for (const part of parts) {
            const known = table.keys.get(part) ?? placeAt(line);
            table.keys.set(part, known);
            table = known.items[known.items.length - 1] ?? known;
        }
        return table;
    }

    // Reads [key] or [[key]]. Returns the place of the table that begins there.
    private header(root: Place): Place {
        const { line } = this;
        ++this.at;
        const isList = this.next === '[';
        if (isList) ++this.at;
        const parts = this.key(']');
        const last = parts.pop()!;
        if (isList) ++this.at;
        const parent = this.descend(root, parts, line);
        if (!isList) return this.descend(parent, [last], line);
        const list = parent.keys.get(last) ?? placeAt(line);
        parent.keys.set(last, list);
        list.items.push(placeAt(line));
        return list.items[list.items.length - 1]!;
    }

    // Reads "key = value" into a table.
    private pair(table: Place): void {
        const { line } = this;
        const place = this.descend(table, this.key('='), line);
        ++this.at;
        this.value(place);
    }

    // Reads a value, up to its last token.
    private value(place: Place): void {
        const close = { '[': ']', '{': '}' }[this.next];
        if (!close) {
            while (!['\n', ',', ']', '}'].includes(this.tokens[this.at + 1]?.text ?? '\n')) ++this.at;
            return;
        }
        for (++this.at; !this.isAtEnd && this.next !== close; ++this.at) {
            if (this.next === '\n' || this.next === ',') continue;
            if (close === '}') this.pair(place);
            else {
                const item = placeAt(this.line);
                place.items.push(item);
                this.value(item);
            }
        }
    }
}

export function readTomlValues(text: string, name: string): TomlTable {
    try {
        return new TomlTable(parse(text, { maxDepth: deepest }), new LineFinder(text).find());
    } catch (error) {
        if (!(error instanceof TomlError)) throw error;
        const why = error.message
            .split('\n')[0]!
            .replace('Invalid TOML document: ', '')
            .replace(/^document contains excessively nested structures.*/, 'the values are too deep');
        const line = text.split('\n')[error.line - 1]!.trim();
        throw new TableError(`${name}:${error.line}: ${why}, in '${shownWord(line)}'`);
    }
}
