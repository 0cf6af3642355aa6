// Shows the column under a click, and reads the same place again in each new grid.

import { ViewGeometry } from '../../camera/geometry';
import { shades } from '../../renderer/shades';
import { nearestTo } from '../../fields/beam_reading';
import { legOf } from '../../earth/measure';
import { Place, Plane, planeOf } from '../../earth/projection';
import { Units, distanceText, heightNumber, heightText, valueText } from '../../tables/units';
import { titleOf } from '../../wire/moments';
import { CellState } from '../../wire/packed_grid';
import { App, Shown } from '../app';
import { button, element, labeledButton, leaveByEscape, make, paragraph, textScale } from '../dom';
import { Drawing } from '../drawing';
import { gridForColumn } from '../exact_column';
import { Keys } from '../keys';
import { pagePixel } from '../labels';
import { Picked, pick } from '../picked';
import { Tool } from '../pointers';
import { ColumnReading, columnAt, readColumn } from '../column_reading';
import { panelTexts } from '../later_texts';
import { stateText, texts } from '../texts';
import { Hover } from './hover';
import { profilePlot } from './profile_plot';

const mostRows = 10;
const markColor = '#ffffff';
const mostDigits = 6; // decimals of a value, which are enough for any code

function summaryOf({ levels, greatest, seenM }: ColumnReading, unit: string, units: Units): string {
    const unknown = [CellState.ambiguous, CellState.rangeFolded] as const;
    const why = unknown.find((state) => levels.some((level) => level.state === state));
    if (!greatest && why !== undefined) return stateText(why);
    if (greatest)
        return panelTexts.greatestAt(
            valueText(greatest.value, unit, units, mostDigits),
            heightText(greatest.heightM, units),
        );
    return seenM === null ? texts.notSeen : texts.noEcho;
}

function putColumn(body: HTMLElement, app: App, reading: ColumnReading): void {
    const { unit } = app;
    const { units } = app.state;
    body.append(paragraph(summaryOf(reading, unit, units)));
    if (reading.seenM) {
        const [fromM, toM] = reading.seenM;
        body.append(
            paragraph(panelTexts.seenBetween(heightNumber(fromM, units), heightText(toM, units))),
            profilePlot(app, reading),
        );
    }
    const table = make('table');
    const told = reading.levels.filter(({ state }) => state !== CellState.notSeen && state !== CellState.noEcho);
    const every = Math.ceil(told.length / mostRows);
    for (const level of told.filter((_, i) => i % every === 0).reverse()) {
        const row = table.insertRow();
        row.insertCell().textContent = heightText(level.heightM, units);
        row.insertCell().textContent =
            level.state === CellState.value
                ? valueText(level.value ?? 0, unit, units, mostDigits)
                : stateText(level.state);
    }
    body.append(table);
}

// Returns a table of keys and what they do.
function keyTable(title: string, rows: readonly (readonly [string, string])[]): HTMLTableElement {
    const table = make('table', {}, make('caption', {}, title));
    for (const [key, told] of rows)
        table.append(make('tr', {}, make('th', { scope: 'row' }, make('kbd', {}, key)), make('td', {}, told)));
    return table;
}

export class Reader implements Tool {
    private at: Plane | null = null; // place of the last click, in meters from the middle of the grid
    // Reading of the last click, its grid, and the values of the other panes.
    private picked: { of: Shown; what: Picked; others: string[] } | null = null;
    private waits: [number, number] | null = null; // pixel of a click for which cells along the ray have not come
    private domain = '';
    private close = labeledButton('reading-close', '×', panelTexts.close, () => this.leave());

    constructor(
        private app: App,
        private drawing: Drawing,
        private pointed: Hover,
    ) {}

    begin(keys: Keys): void {
        this.domain = this.app.state.domain;
        this.app.on('choices', () => this.takeDomain());
        this.app.on(['shown', 'units'], () => {
            if (this.at) this.put();
        });
        this.app.on('cells', () => {
            if (this.waits) this.click(...this.waits);
        });
        this.app.on('camera', () => (this.waits = null));
        leaveByEscape(element('reading'), 'picture', () => this.clear());
        keys.add('Escape', () => this.clear());
        keys.add('?', () => this.showHelp());
        this.drawing.addOverlay((pen, geometry) => this.draw(pen, geometry));
        element('actions').append(button('help', panelTexts.help, () => this.showHelp()));
        element('scan-open').after(labeledButton('keys-open', '?', panelTexts.help, () => this.showHelp()));
    }

    hover(x: number, y: number): void {
        this.pointed.over(x, y);
    }

    // Called when another tool takes the pointer.
    end(): void {
        this.pointed.hide();
    }
    click(x: number, y: number): void {
        const what = pick(this.drawing, x, y, true);
        const { shown } = this.app;
        this.waits = what?.lacksCells ? [x, y] : null;
        const others = this.pointed.linesOfOthers([x, y]);
        this.picked = what && shown && !this.waits ? { of: shown, what, others } : null;
        this.at = what?.at ?? null;
        this.put();
        this.drawing.drawMarks();
    }

    // Marks the clicked column, from the ground up to the height of the reading.
    private draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry): void {
        const { at, picked } = this;
        if (!at) return;
        const pixelAt = (heightM: number) => pagePixel(geometry, at, heightM);
        const foot = pixelAt(geometry.groundM);
        const head = picked?.of === this.app.shown ? pixelAt(picked.what.heightM) : foot;
        if (!foot || !head) return;
        const scale = textScale();
        for (const [color, width] of [
            [shades.halo, 4],
            [markColor, 1.5],
        ] as const) {
            pen.strokeStyle = color;
            pen.lineWidth = width * scale;
            pen.beginPath();
            pen.moveTo(...foot);
            pen.lineTo(...head);
            pen.stroke();
            pen.beginPath();
            pen.arc(...foot, 6 * scale, 0, 2 * Math.PI);
            pen.stroke();
        }
        pen.beginPath();
        pen.arc(...head, 3 * scale, 0, 2 * Math.PI);
        pen.fillStyle = markColor;
        pen.fill();
    }

    // Drops the place if the domain has changed.
    private takeDomain(): void {
        if (this.domain !== this.app.state.domain) this.clear();
        this.domain = this.app.state.domain;
    }

    private leave(): void {
        this.clear();
        element('picture').focus();
    }
    private clear(): void {
        this.at = this.picked = this.waits = null;
        element('reading').hidden = true;
        this.drawing.drawMarks();
    }

    private put(): void {
        const box = element('reading');
        const { shown } = this.app;
        box.hidden = !this.at || !shown;
        if (!this.at || !shown) return;
        const { grid } = shown.loaded;
        const { at } = this;
        const column = columnAt(grid, ...at);
        const place = planeOf(grid).toPlace(this.at);
        const title = make('h2', {}, panelTexts.place(place.latitudeDeg, place.longitudeDeg));
        const near = this.nearestCity(place);
        const body = make('div');
        // Tell the reading of the click only while the same grid is shown. Read the column in each new grid.
        const { picked } = this;
        const said =
            picked?.of === shown && picked.what.state !== null
                ? [...this.pointed.lines(picked.what), ...picked.others]
                : [];
        if (picked?.of === shown) this.pointed.whenTold(() => this.at === at && this.put());
        const from = said.length === 0 ? this.fromRadar(place) : '';
        if (near || from) body.append(paragraph([near, from].filter(Boolean).join(', ')));
        if (said.length > 0) body.append(...said.map(paragraph), paragraph(panelTexts.column));
        if (!column) body.append(paragraph(panelTexts.hover.outside));
        if (column) {
            gridForColumn(shown.loaded, column)
                .then((exact) => {
                    if (this.at !== at || this.app.shown !== shown) return;
                    putColumn(body, this.app, readColumn(exact, ...column));
                    this.drawing.drawMarks();
                })
                .catch((error: unknown) => this.app.fail(error));
        }
        box.replaceChildren(this.close, title, body);
        this.drawing.drawMarks();
    }

    // Tells distance and direction from the nearest city on the map; an empty text without one.
    private nearestCity(place: Place): string {
        const { shown, state } = this.app;
        if (!shown) return '';
        const plane = planeOf(shown.loaded.grid);
        const ways = this.drawing.cities.map(({ at, text }) => ({ text, ...legOf(plane.toPlace(at), place) }));
        const nearest = ways.sort((a, b) => a.distanceM - b.distanceM)[0];
        if (!nearest) return '';
        return panelTexts.near(distanceText(nearest.distanceM, state.units), nearest.azimuthDeg, nearest.text);
    }

    // Tells distance and direction from the nearest radar.
    private fromRadar(place: Place): string {
        const { shown, state } = this.app;
        const nearest = nearestTo(shown?.loaded.grid.sites ?? [], place);
        if (!nearest) return '';
        const { distanceM, azimuth } = nearest.way;
        return panelTexts.hover.from(
            distanceText(distanceM, state.units),
            (azimuth * 180) / Math.PI,
            nearest.site.icao,
        );
    }

    private showHelp(): void {
        this.clear();
        const box = element('reading');
        const moments = this.app.domain?.moments.map(({ moment }) => [moment, titleOf(moment)] as const) ?? [];
        const groups = [[panelTexts.moments, moments] as const, ...panelTexts.keys].map(([title, rows]) =>
            keyTable(title, rows),
        );
        box.replaceChildren(this.close, make('h2', {}, panelTexts.help), make('div', { class: 'keys' }, ...groups));
        box.hidden = false;
    }
}
