// Lists storm cells in a table. A click on the name of a column sorts by this column; another click reverses the order.

import { Units, heightText, shownUnit } from '../../tables/units';
import { StormCell } from '../storm_cells';
import { make } from '../dom';

// Texts of the table, which are not in texts.ts, because texts.ts is part of the first program of the page.
const words = {
    title: 'Storm cells',
    none: 'No storm cell at this time',
    unavailable: 'The server has no storm cells of this area',
    atLeast: 'at least',
    unknown: '–',
};

interface Column {
    name: string;
    hint: string;
    of: (cell: StormCell) => number | null; // by which rows are sorted
    text: (cell: StormCell, units: Units) => string;
}

const numberText = (value: number | null, digits: number): string => value?.toFixed(digits) ?? words.unknown;

export const columns: readonly Column[] = [
    { name: 'dBZ', hint: 'largest reflectivity', of: (cell) => cell.maxDbz, text: (cell) => cell.maxDbz.toFixed(0) },
    {
        name: 'Top',
        hint: 'height of the echo of 18 dBZ above sea level; >: no beam saw the air above',
        of: (cell) => cell.topM,
        text: (cell, units) => `${cell.isTopAtLeast ? '> ' : ''}${heightText(cell.topM, units)}`,
    },
    {
        name: 'VIL',
        hint: 'liquid water of the column, kg/m²',
        of: (cell) => cell.vilKgM2,
        text: (cell) => cell.vilKgM2.toFixed(0),
    },
    {
        name: 'MESH',
        hint: 'size of hail that a quarter of the reported stones exceed, mm; it depends on assumed freezing levels',
        of: (cell) => cell.meshMm,
        text: (cell) => numberText(cell.meshMm, 0),
    },
    {
        name: 'Shear',
        hint: 'largest azimuthal shear, 0.001/s',
        of: (cell) => cell.shearPerS,
        text: (cell) => numberText(cell.shearPerS === null ? null : 1000 * cell.shearPerS, 1),
    },
    { name: 'From', hint: 'direction from which it comes', of: (cell) => cell.fromDeg, text: fromText },
    { name: 'Speed', hint: 'speed and its standard error', of: (cell) => cell.speedMps, text: speedText },
];

function fromText(cell: StormCell): string {
    return cell.fromDeg === null ? words.unknown : `${cell.fromDeg.toFixed(0)}°`;
}
function speedText(cell: StormCell, units: Units): string {
    if (cell.speedMps === null) return words.unknown;
    const unit = shownUnit('m/s', units);
    const shown = (mps: number) => (mps * unit.perStored).toFixed(0);
    return `${shown(cell.speedMps)} ± ${shown(cell.speedErrorMps ?? 0)} ${unit.symbol}`;
}

// Returns the cells by a column, unknown values last.
export function sortedCells(cells: readonly StormCell[], column: number, isRising: boolean): StormCell[] {
    const { of } = columns[column]!;
    const sign = isRising ? 1 : -1;
    return [...cells].sort((a, b) => {
        const [x, y] = [of(a), of(b)];
        if (x === null || y === null) return Number(x === null) - Number(y === null);
        return sign * (x - y);
    });
}

export class CellTable {
    private column = 0;
    private isRising = false;
    private body = make('tbody');
    private heads = columns.map(({ name, hint }, i) => {
        const press = make('button', { type: 'button', title: hint }, name);
        press.addEventListener('click', () => this.sortBy(i));
        return make('th', { scope: 'col' }, press);
    });
    private caption = make('caption', {}, words.title);
    readonly box = make(
        'section',
        { id: 'cells', hidden: '', 'aria-label': words.title },
        make('table', {}, this.caption, make('thead', {}, make('tr', {}, ...this.heads)), this.body),
    );
    private cells: readonly StormCell[] = [];
    private units: Units | null = null;
    private isKnown = true;

    // `look` is called with the cell of a clicked row.
    constructor(private look: (cell: StormCell) => void) {}

    private sortBy(column: number): void {
        this.isRising = column === this.column && !this.isRising;
        this.column = column;
        this.fill();
    }

    // `isKnown` is false if the server does not tell the cells.
    put(cells: readonly StormCell[], units: Units, isKnown: boolean): void {
        if (this.cells === cells && this.units === units && this.isKnown === isKnown) return;
        [this.cells, this.units, this.isKnown] = [cells, units, isKnown];
        this.fill();
    }

    private fill(): void {
        const { units } = this;
        if (!units) return;
        const empty = this.isKnown ? words.none : words.unavailable;
        this.caption.textContent = this.cells.length > 0 ? words.title : empty;
        this.heads.forEach((head, i) => {
            const order = this.isRising ? 'ascending' : 'descending';
            head.setAttribute('aria-sort', i === this.column ? order : 'none');
        });
        this.body.replaceChildren(
            ...sortedCells(this.cells, this.column, this.isRising).map((cell) => {
                const row = make('tr', { title: cell.id, tabindex: '0' });
                row.append(...columns.map(({ text }) => make('td', {}, text(cell, units))));
                row.addEventListener('click', () => this.look(cell));
                row.addEventListener('keydown', ({ key }) => key === 'Enter' && this.look(cell));
                return row;
            }),
        );
    }
}
