// Reads TOML 1.0 as far as tables of colors need it: keys, texts, numbers, flags, arrays, inline tables,
// [tables] and [[lists of tables]]; dates and texts of several lines are refused.
//
// Errors: a TableError, "FILE:LINE: why". Nothing is deeper than `deepest`, so that no text exhausts the
// stack.

import { TableError, shownWord } from './table_file';

export type TomlValue = string | number | boolean | TomlArray | TomlTable;
export class TomlArray {
    constructor(
        readonly items: TomlValue[],
        readonly isOfTables = false, // made by [[ ]], which may add to it
    ) {}
}
export class TomlTable {
    private entries = new Map<string, { value: TomlValue; line: number }>();
    constructor(readonly line: number) {}

    get keys(): string[] {
        return [...this.entries.keys()];
    }
    has(key: string): boolean {
        return this.entries.has(key);
    }
    get(key: string): TomlValue | undefined {
        return this.entries.get(key)?.value;
    }
    lineOf(key: string): number {
        return this.entries.get(key)?.line ?? this.line;
    }
    put(key: string, value: TomlValue, line: number): void {
        this.entries.set(key, { value, line });
    }
}

const deepest = 16;
const bareKey = /[A-Za-z0-9_-]+/y;
const number =
    /[+-]?(?:inf|nan|0x[0-9a-fA-F_]+|0o[0-7_]+|0b[01_]+|(?:0|[1-9](?:_?\d)*)(?:\.\d(?:_?\d)*)?(?:[eE][+-]?\d(?:_?\d)*)?)(?![\w.:-])/y;
const blank = /[ \t]*/y;
const blankLines = /(?:[ \t\r\n]|#[^\n]*)*/y;
const escapes: Record<string, string> = { b: '\b', t: '\t', n: '\n', f: '\f', r: '\r', '"': '"', '\\': '\\' };

class TomlReader {
    private at = 0;
    private counted = { to: 0, line: 1 };

    constructor(
        private text: string,
        private name: string,
    ) {}

    read(): TomlTable {
        const root = new TomlTable(1);
        let table = root;
        for (;;) {
            this.skip(blankLines);
            if (this.at >= this.text.length) return root;
            if (this.text[this.at] === '[') table = this.header(root);
            else this.pair(table, 0);
            this.endOfLine();
        }
    }

    private get line(): number {
        const { counted } = this;
        for (
            let i = this.text.indexOf('\n', counted.to);
            i >= 0 && i < this.at;
            i = this.text.indexOf('\n', counted.to)
        ) {
            ++counted.line;
            counted.to = i + 1;
        }
        return counted.line;
    }
    private refuse(why: string): never {
        throw new TableError(`${this.name}:${this.line}: ${why}`);
    }
    private match(pattern: RegExp): string | null {
        pattern.lastIndex = this.at;
        const found = pattern.exec(this.text)?.[0] ?? null;
        if (found !== null) this.at += found.length;
        return found;
    }
    private skip(pattern: RegExp): void {
        this.match(pattern);
    }
    private take(word: string): boolean {
        if (!this.text.startsWith(word, this.at)) return false;
        this.at += word.length;
        return true;
    }
    private need(word: string): void {
        this.skip(blank);
        if (!this.take(word)) this.refuse(`'${word}' is missing`);
    }
    private endOfLine(): void {
        this.skip(blank);
        if (this.at < this.text.length && !/[\r\n#]/.test(this.text[this.at]!)) {
            this.refuse(`'${shownWord(this.text.slice(this.at, this.at + 20))}' has no meaning here`);
        }
    }

    private key(): string[] {
        const parts: string[] = [];
        do {
            this.skip(blank);
            const quote = this.text[this.at];
            const part = quote === '"' || quote === "'" ? this.quoted() : this.match(bareKey);
            if (part === null) this.refuse('a key is missing');
            parts.push(part);
            this.skip(blank);
        } while (this.take('.'));
        if (parts.length > deepest) this.refuse('the key has too many parts');
        return parts;
    }

    // [key] or [[key]]
    private header(root: TomlTable): TomlTable {
        const line = this.line;
        const isList = this.take('[[') || (this.need('['), false);
        const parts = this.key();
        this.need(isList ? ']]' : ']');
        const last = parts.pop()!;
        const parent = this.tableAt(root, parts);
        const known = parent.get(last);
        const table = new TomlTable(line);
        if (isList) {
            if (known === undefined) parent.put(last, new TomlArray([table], true), line);
            else if (known instanceof TomlArray && known.isOfTables) known.items.push(table);
            else this.refuse(`'${shownWord(last)}' is there already`);
            return table;
        }
        if (known !== undefined) this.refuse(`'${shownWord(last)}' is there already`);
        parent.put(last, table, line);
        return table;
    }
    private tableAt(table: TomlTable, parts: string[]): TomlTable {
        for (const part of parts) {
            let next = table.get(part);
            if (next instanceof TomlArray && next.isOfTables) next = next.items[next.items.length - 1];
            if (next === undefined) {
                next = new TomlTable(this.line);
                table.put(part, next, this.line);
            }
            if (!(next instanceof TomlTable)) this.refuse(`'${shownWord(part)}' is no table`);
            table = next;
        }
        return table;
    }

    // key = value
    private pair(table: TomlTable, depth: number): void {
        const line = this.line;
        const parts = this.key();
        this.need('=');
        const last = parts.pop()!;
        const parent = this.tableAt(table, parts);
        if (parent.has(last)) this.refuse(`'${shownWord(last)}' is there already`);
        parent.put(last, this.value(depth), line);
    }

    private value(depth: number): TomlValue {
        this.skip(blank);
        if (depth > deepest) this.refuse('the values are too deep');
        switch (this.text[this.at]) {
            case '"':
            case "'":
                return this.quoted();
            case '[':
                return this.array(depth);
            case '{':
                return this.inlineTable(depth);
        }
        const flag = this.match(/(?:true|false)(?![\w.-])/y);
        if (flag) return flag === 'true';
        const word = this.match(number);
        if (word === null)
            this.refuse(`'${shownWord(this.text.slice(this.at, this.at + 70).split(/[\s,\]}]/)[0]!)}' is no value`);
        const plain = word.replace(/_/g, '');
        if (plain.endsWith('inf')) return plain.startsWith('-') ? -Infinity : Infinity;
        return Number(plain);
    }

    private array(depth: number): TomlArray {
        this.need('[');
        const items: TomlValue[] = [];
        for (;;) {
            this.skip(blankLines);
            if (this.take(']')) return new TomlArray(items);
            items.push(this.value(depth + 1));
            this.skip(blankLines);
            if (!this.take(',') && this.text[this.at] !== ']') this.refuse("',' or ']' is missing");
        }
    }

    private inlineTable(depth: number): TomlTable {
        const table = new TomlTable(this.line);
        this.need('{');
        this.skip(blank);
        if (this.take('}')) return table;
        do this.pair(table, depth + 1);
        while ((this.skip(blank), this.take(',')));
        this.need('}');
        return table;
    }

    private quoted(): string {
        const quote = this.text[this.at]!;
        if (this.text.startsWith(quote.repeat(3), this.at)) this.refuse('texts of several lines are not read');
        let text = '';
        for (++this.at; ; ++this.at) {
            const letter = this.text[this.at];
            if (letter === undefined || letter === '\n') this.refuse('a text has no end');
            if (letter === quote) break;
            text += letter === '\\' && quote === '"' ? this.escaped() : letter;
        }
        ++this.at;
        return text;
    }
    private escaped(): string {
        const letter = this.text[++this.at] ?? '';
        const known = escapes[letter];
        if (known !== undefined) return known;
        const digits = letter === 'u' ? 4 : letter === 'U' ? 8 : 0;
        const code = this.text.slice(this.at + 1, this.at + 1 + digits);
        if (digits === 0 || !/^[0-9a-fA-F]+$/.test(code) || code.length !== digits || parseInt(code, 16) > 0x10ffff) {
            this.refuse(`'\\${shownWord(letter)}' has no meaning in a text`);
        }
        this.at += digits;
        return String.fromCodePoint(parseInt(code, 16));
    }
}

export function readTomlValues(text: string, name: string): TomlTable {
    return new TomlReader(text, name).read();
}
