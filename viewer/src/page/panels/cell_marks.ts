// Marks the storm cells of the shown grid: a ring with the largest reflectivity, the track behind it, and the forecast
// ahead with a ring of its error after 30 and 60 minutes.

import { ViewGeometry } from '../../camera/geometry';
import { Place, Plane, planeOf } from '../../earth/projection';
import { shades } from '../../renderer/shades';
import { cells } from '../../wire/api';
import { StormCell, readCells } from '../storm_cells';
import { App, Shown } from '../app';
import { fontOf, textScale } from '../dom';
import { Drawing } from '../drawing';
import { FetchedInTurn } from '../fetched_in_turn';
import { haloed, pagePixel } from '../labels';
import { Pane } from '../pane';
import { CellTable } from './cell_table';

const mostBytes = 4 * 2 ** 20; // of answers that are kept
const bytesOfCell = 1000;
const cellRadius = 9;
const ringMinutes = [30, 60];
const aheadColor = 'rgb(255 220 80)';
const none: readonly StormCell[] = [];

type Pixel = [number, number];

// The cells are those of a volume, whatever the moment.
const keyOf = ({ domain, time }: Shown): string => `${domain} ${time}`;

export class CellMarks {
    private answers = new FetchedInTurn<StormCell[]>(mostBytes, (list) => bytesOfCell * (1 + list.length));
    private asked = ''; // key of the grid whose cells are being fetched
    private table = new CellTable((cell) => this.lookAt(cell));

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    begin(): void {
        document.querySelector('main')!.append(this.table.box);
        this.drawing.addOverlay((pen, geometry, pane) => this.draw(pen, geometry, pane));
        this.app.on(['view', 'shown', 'units', 'cells'], () => this.put());
        this.put();
    }

    // Returns the cells of the grid that a pane shows, and fetches them first if they have not come.
    private cellsOf({ shown, state }: Pick<Pane, 'shown' | 'state'>): readonly StormCell[] | null {
        if (!shown || !state.layers.hasCells) return null;
        const key = keyOf(shown);
        if (this.answers.isNeeded(key) && this.asked !== key) void this.fetch(shown);
        return this.answers.find(key) ?? none;
    }
    private async fetch(shown: Shown): Promise<void> {
        const { domain, time } = shown;
        const key = (this.asked = keyOf(shown));
        await this.answers.take(key, async () => readCells(await cells(domain, time)), false);
        this.asked = '';
        this.app.cellsCame();
    }

    private put(): void {
        const found = this.cellsOf(this.app);
        this.table.box.hidden = found === null;
        const { shown } = this.app;
        const isKnown = !shown || this.answers.errorOf(keyOf(shown)) === undefined;
        if (found) this.table.put(found, this.app.state.units, isKnown);
        this.drawing.draw();
    }

    private lookAt({ place }: StormCell): void {
        const { shown, state } = this.app;
        const at = shown && planeOf(shown.loaded.grid).toPlane(place);
        if (at) this.app.moved({ ...state.camera, lookAtM: [at[0], at[1], state.camera.lookAtM?.[2] ?? 0] });
    }

    private draw(pen: CanvasRenderingContext2D, geometry: ViewGeometry, pane: Pane): void {
        const found = this.cellsOf(pane);
        const { shown } = pane;
        if (pane.isActive) document.documentElement.dataset['cells'] = String(found?.length ?? 0);
        if (!found || !shown) return;
        const plane = planeOf(shown.loaded.grid);
        const pixelOf = (place: Place): Pixel | null => {
            const at = plane.toPlane(place);
            return at && pagePixel(geometry, at, geometry.groundM);
        };
        for (const cell of found) {
            line(pen, cell.track.map(pixelOf), shades.quietText);
            line(
                pen,
                cell.ahead.map(({ place }) => pixelOf(place)),
                aheadColor,
            );
            for (const { minutes, place, errorM } of cell.ahead) {
                const at = plane.toPlane(place);
                if (at && ringMinutes.includes(minutes)) line(pen, ringOf(geometry, at, errorM), aheadColor);
            }
        }
        // The strongest cells come last, over the other cells.
        for (const cell of [...found].reverse()) mark(pen, pixelOf(cell.place), cell.maxDbz.toFixed(0));
    }
}

// Returns a ring on the ground.
function ringOf(geometry: ViewGeometry, [x, y]: Plane, radiusM: number): (Pixel | null)[] {
    return Array.from({ length: 33 }, (_, i) => {
        const angle = (i * Math.PI) / 16;
        const at: Plane = [x + radiusM * Math.cos(angle), y + radiusM * Math.sin(angle)];
        return pagePixel(geometry, at, geometry.groundM);
    });
}

// Draws a line with a dark halo. It has gaps where a point is behind the camera.
function line(pen: CanvasRenderingContext2D, points: (Pixel | null)[], color: string): void {
    pen.beginPath();
    let isDown = false;
    for (const point of points) {
        if (point && isDown) pen.lineTo(...point);
        else if (point) pen.moveTo(...point);
        isDown = point !== null;
    }
    for (const [width, shade] of [
        [4, shades.halo],
        [1.6, color],
    ] as const) {
        pen.lineWidth = width * textScale();
        pen.strokeStyle = shade;
        pen.stroke();
    }
}

function mark(pen: CanvasRenderingContext2D, at: Pixel | null, text: string): void {
    if (!at) return;
    const radius = cellRadius * textScale();
    line(
        pen,
        Array.from({ length: 33 }, (_, i): Pixel => [
            at[0] + radius * Math.cos((i * Math.PI) / 16),
            at[1] + radius * Math.sin((i * Math.PI) / 16),
        ]),
        shades.text,
    );
    pen.font = fontOf(12 * textScale(), 'bold');
    pen.textAlign = 'left';
    pen.textBaseline = 'middle';
    haloed(pen, text, at[0] + radius + 4, at[1], shades.text);
}
