// Reads and writes color tables of the GRLevelX programs, as render/color/pal_file.cpp does. color_file.h says what
// each key means.
//
// Errors: a TableError, "FILE:LINE: why".

import { colorFiles, palProducts, palUnits } from '../facts';
import { ColorStop, ColorTable, Rgba } from '../wire/color_tables';
import { TableError, endOf, greatestValue, knownMoments, mostStops, shownWord, usualExtinctionOf } from './table_file';
import { UsualOpacity } from './usual_opacity';

interface Entry {
    value: number;
    color: Rgba;
    until: Rgba | null;
    isSolid: boolean;
}

const momentsOfUnits: Record<string, string> = { dBZ: 'REF', 'm/s': 'VEL' };
const inList = <T>(list: Record<string, T>, key: string): T | undefined =>
    Object.prototype.hasOwnProperty.call(list, key) ? list[key] : undefined;

const wordsOf = (text: string): string[] => text.split(/[ \t\r,\f]+/).filter((word) => word !== '');

class PalReader {
    private line = 0;
    private entries: Entry[] = [];
    private numbers: Record<'SCALE' | 'OFFSET' | 'STEP', number | null> = { SCALE: null, OFFSET: null, STEP: null };
    private folded: Rgba | null = null;
    private product = '';
    private unit = '';

    constructor(private name: string) {}

    takeLine(whole: string): void {
        ++this.line;
        const line = whole.split(';', 1)[0]!;
        const words = wordsOf(line);
        if (words.length === 0 || words[0]!.startsWith('#')) return;
        const colon = line.indexOf(':');
        const keys = wordsOf(line.slice(0, Math.max(0, colon)));
        if (keys.length !== 1) this.refuse(`'${shownWord(words[0]!)}' is not followed by a colon, as in 'Key: value'`);
        this.take(keys[0]!.toUpperCase(), wordsOf(line.slice(colon + 1)));
    }

    private refuse(why: string): never {
        throw new TableError(`${this.name}:${this.line}: ${why}`);
    }

    private take(key: string, words: string[]): void {
        const entry = /^(SOLID)?COLOU?R(4)?$/.exec(key);
        if (entry) return this.takeEntry(words, entry[2] ? 4 : 3, entry[1] !== undefined);
        switch (key) {
            case 'SCALE':
            case 'STEP':
            case 'OFFSET':
                this.numbers[key] = this.number(words, key !== 'OFFSET');
                return;
            case 'RF':
                this.folded = this.colorOfWords(words);
                return;
            case 'ND':
                this.colorOfWords(words);
                return;
            case 'PRODUCT':
                this.product = (words[0] ?? '').toUpperCase();
                return;
            case 'UNITS':
            case 'UNIT':
                this.unit = shownWord(words[0] ?? '');
                return;
            case 'DECIMALS':
            case 'CATEGORY':
            case 'TITLE':
            case 'NAME':
                return;
        }
        this.refuse(
            `unknown key '${shownWord(key)}'; the known keys are Product, Units, Scale, Offset, Step, RF, ND, Color, Color4, SolidColor, SolidColor4`,
        );
    }

    private numberOf(word: string): number | null {
        const number = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(word) ? Number(word) : NaN;
        return Math.abs(number) <= greatestValue ? number : null;
    }
    private number(words: string[], isAboveZero: boolean): number {
        if (words.length !== 1) this.refuse(`there must be one number, not ${words.length} words`);
        const number = this.numberOf(words[0]!);
        if (number === null) this.refuse(`'${shownWord(words[0]!)}' is not a number up to a million`);
        if (isAboveZero && number < 1e-9) this.refuse('the number must be above 0');
        return number;
    }
    private color(words: string[]): Rgba {
        const channels = words.map((word) => {
            const number = this.numberOf(word);
            if (number === null || number < 0 || number > 255) {
                this.refuse(`'${shownWord(word)}' is not a color; red, green, blue and alpha are 0 to 255`);
            }
            return Math.round(number);
        });
        return [...channels, 255].slice(0, 4) as Rgba;
    }
    private colorOfWords(words: string[]): Rgba {
        if (words.length < 3 || words.length > 4)
            this.refuse(`there must be red, green and blue, not ${words.length} numbers`);
        return this.color(words);
    }

    private takeEntry(words: string[], channels: number, isSolid: boolean): void {
        if (words.length !== 1 + channels && words.length !== 1 + 2 * channels) {
            this.refuse(
                `there must be a value and ${channels} or ${2 * channels} numbers of color, not ${words.length} numbers in all`,
            );
        }
        if (this.entries.length === mostStops) this.refuse(`there are more than ${mostStops} colors`);
        const value = this.numberOf(words[0]!);
        if (value === null) this.refuse(`'${shownWord(words[0]!)}' is not a number up to a million`);
        const until = words.slice(1 + channels);
        this.entries.push({
            value,
            color: this.color(words.slice(1, 1 + channels)),
            until: until.length > 0 ? this.color(until) : null,
            isSolid,
        });
    }

    // Returns the moment and the unit of the values, and how many units of the file make one unit of the values.
    private meaning(): { moment: string; unit: string; perOurs: number } {
        let moment = '';
        let unit = '';
        const product = inList(palProducts, this.product);
        if (inList(knownMoments, this.product) !== undefined)
            [moment, unit] = [this.product, knownMoments[this.product]!];
        else if (product) [moment, unit] = [product.moment ?? '', product.unit];
        const hasMeaning = moment !== '' || unit !== '';
        const known = inList(palUnits, this.unit.toUpperCase());
        if (!hasMeaning) {
            unit = known ? known[1] : this.unit;
            if (known) moment = momentsOfUnits[unit] ?? '';
        }
        return { moment, unit, perOurs: this.numbers.SCALE ?? (known?.[1] === unit ? known[0] : 1) };
    }

    private stops(perOurs: number): ColorStop[] {
        const entries = [...this.entries];
        if (entries[0]!.value > entries[entries.length - 1]!.value) entries.reverse();
        entries.sort((a, b) => a.value - b.value);
        const stops: ColorStop[] = [];
        entries.forEach(({ value, color, until, isSolid }, i) => {
            const from = Math.fround((value - (this.numbers.OFFSET ?? 0)) / perOurs);
            const end = isSolid ? color : (until ?? entries[i + 1]?.color ?? color);
            const last = stops[stops.length - 1];
            if (last && last.from >= from) stops[stops.length - 1] = { from: last.from, color, until: end };
            else stops.push({ from, color, until: end });
        });
        return stops;
    }

    finish(usual: UsualOpacity): ColorTable {
        if (this.entries.length === 0) this.refuse('the file has no Color: or SolidColor:');
        const { moment, unit, perOurs } = this.meaning();
        const stops = this.stops(perOurs);
        const [first, last] = [stops[0]!, stops[stops.length - 1]!];
        const table: ColorTable = {
            name: '',
            moment,
            unit,
            stops,
            end: 0,
            bar_begin: first.from,
            range_folded: this.folded ?? [...colorFiles.rangeFolded],
            extinction: [],
        };
        const step = (this.numbers.STEP ?? 0) / perOurs;
        table.end = Math.max(step > 0 ? last.from + step : endOf(table), last.from + 1e-6);
        table.extinction = usualExtinctionOf(table, usual);
        if (![...stops.map((stop) => stop.from), table.end].every(Number.isFinite))
            this.refuse('the values are not finite');
        return table;
    }
}

// Reads a table. Its name is empty, and its moment is empty if the file names none. `fileName` is for errors.
export function readPal(text: string, fileName: string, usual: UsualOpacity): ColorTable {
    const reader = new PalReader(fileName);
    for (const line of text.split('\n')) reader.takeLine(line);
    return reader.finish(usual);
}

const productOf: Record<string, string> = { REF: 'BR', VEL: 'BV', RHO: 'CC' };

// Writes a table whose alpha is its opacity relative to the usual opacity. A color blends to the color of the next
// line, or to a second color in its own line if that differs.
export function writePal(table: ColorTable): string {
    const lines = [`; ${table.name.replace(/[^\x20-\x7e]/g, '?')}, for stormcellar frame --colors FILE`];
    lines.push(`Product: ${productOf[table.moment] ?? table.moment}`);
    if (table.unit) lines.push(`Units: ${table.unit.toUpperCase()}`);
    const last = table.stops[table.stops.length - 1]!;
    lines.push(`Step: ${Number((table.end - last.from).toFixed(4))}`);
    lines.push(`RF: ${table.range_folded.slice(0, 3).join(' ')}`);
    table.stops.forEach(({ from, color, until }, i) => {
        const next = table.stops[i + 1];
        const value = Number(from.toFixed(4));
        if (!next || color.every((c, k) => c === until[k])) lines.push(`SolidColor4: ${value} ${color.join(' ')}`);
        else if (until.every((c, k) => c === next.color[k])) lines.push(`Color4: ${value} ${color.join(' ')}`);
        else lines.push(`Color4: ${value} ${color.join(' ')} ${until.join(' ')}`);
    });
    return `${lines.join('\n')}\n`;
}
