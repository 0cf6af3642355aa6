// Chooses the cut that the layer of a sweep shows: from a list of all cuts, or a step to the next tilt.

import { cutOf, isChosen, nextTilt, tiltsOf } from '../../fields/sweep_choice';
import { lowestTiltDeg, sweepMoment } from '../../scene/layers';
import { SweepRow } from '../../wire/api';
import { App } from '../app';
import { button, element, labeledButton, make, putOptions } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { cutText } from '../layer_maker';
import { panelTexts } from '../later_texts';

const words = panelTexts.tilts;
const momentOf = ({ state, shown }: App): string => sweepMoment(state.layers, shown?.moment ?? state.moment);

// Returns the cut that the user wants, which may not have come yet; null if its volume has not come.
function wantedCut(app: App, rows: SweepRow[]): SweepRow | null {
    const { sweepDeg, sweepNumber } = app.state.layers;
    return sweepDeg === null ? null : cutOf(rows, momentOf(app), sweepDeg, sweepNumber);
}

// Shows a cut by its elevation, and also by its number if pictures take another cut of this elevation.
function show(app: App, row: SweepRow): void {
    app.state.layers = {
        ...app.state.layers,
        sweepDeg: Number(row.elevation_deg.toFixed(2)),
        sweepNumber: isChosen(row, momentOf(app)) ? null : row.sweep,
    };
    app.changed();
}

// Returns a button with which the user shows a cut, or null if the cut lacks the shown moment. Also returns a function
// that presses the button if the cut is shown. A press first calls `before`.
export function cutButton(
    app: App,
    row: SweepRow,
    rows: SweepRow[],
    idBegin = 'cut',
    before: () => void = () => undefined,
): { shows: HTMLButtonElement; put: () => void } | null {
    const moment = momentOf(app);
    if (tiltsOf([row], moment).length === 0) return null;
    const shows = button(`${idBegin}-${row.sweep}`, words.at(row.elevation_deg), () => {
        before();
        show(app, row);
    });
    shows.setAttribute('aria-label', cutText(row, rows));
    const put = () => shows.setAttribute('aria-pressed', String(wantedCut(app, rows)?.sweep === row.sweep));
    put();
    return { shows, put };
}

// Makes a list of cuts show a cut that the user chooses.
export function listenToCuts(app: App, { layers }: Drawing, list: HTMLSelectElement): void {
    list.addEventListener('change', () => {
        const row = layers.sweepRows()?.find((one) => one.sweep === Number(list.value));
        if (row) show(app, row);
    });
}

// Fills a list with the cuts of the shown volume that have the moment, the highest tilt first.
export function putCuts(app: App, { layers }: Drawing, list: HTMLSelectElement): void {
    const rows = layers.sweepRows() ?? [];
    const cuts = tiltsOf(rows, momentOf(app)).reverse().flat();
    const { sweepDeg } = app.state.layers;
    if (cuts.length === 0)
        return putOptions(list, [''], '', () => (sweepDeg === null ? words.none : words.at(sweepDeg)));
    putOptions(
        list,
        cuts.map(({ sweep }) => String(sweep)),
        String(wantedCut(app, rows)?.sweep),
        (number) =>
            cutText(
                cuts.find(({ sweep }) => String(sweep) === number)!,
                rows,
            ),
    );
}

// Adds the list of cuts, and buttons and keys for the next tilt, which are there in 2D.
export function addTilts(app: App, drawing: Drawing, keys: Keys): void {
    const next = (by: 1 | -1): SweepRow | null => {
        const rows = drawing.layers.sweepRows() ?? [];
        const wanted = wantedCut(app, rows);
        return wanted && nextTilt(rows, momentOf(app), wanted, by);
    };
    const step = (by: 1 | -1) => {
        const { layers, isFlat } = app.state;
        if (!isFlat) return;
        const row = next(by);
        if (row) return show(app, row);
        if (layers.sweepDeg !== null) return;
        app.state.layers = { ...layers, sweepDeg: lowestTiltDeg };
        app.changed();
    };
    const list = make('select', { id: 'tilt', 'aria-label': words.list });
    listenToCuts(app, drawing, list);
    const ways = [
        ['tilt-lower', '▼', words.lower, -1],
        ['tilt-higher', '▲', words.higher, 1],
    ] as const;
    const box = make('div', { id: 'tilts', role: 'group', 'aria-label': words.name }, list);
    for (const [id, sign, name, by] of ways)
        list[by > 0 ? 'after' : 'before'](labeledButton(id, sign, name, () => step(by)));
    element('sight').append(box);
    keys.add('ArrowUp', () => step(1));
    keys.add('ArrowDown', () => step(-1));
    const put = () => {
        box.hidden = !app.state.isFlat;
        if (box.hidden) return;
        putCuts(app, drawing, list);
        const isOff = app.state.layers.sweepDeg === null;
        for (const [id, , , by] of ways) element(id).setAttribute('aria-disabled', String(!isOff && !next(by)));
    };
    app.on(['view', 'shown', 'choices'], put);
    drawing.share.layerCame.push(put);
    put();
}
