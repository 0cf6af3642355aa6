// Adds the settings of the view: colors, threshold, opacity, exaggeration of heights, and camera.

import { cameraOfFitted } from '../../scene/fitted';
import { fittedView, isRegion } from '../../wire/api';
import { valueText } from '../../tables/units';
import { usualRungs } from '../../renderer/ladder';
import { App } from '../app';
import { button, element, leaveByEscape, press, putOptions } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { tableTitle } from '../table_book';
import { TableEditing } from '../table_editing';
import { panelTexts } from '../later_texts';

function putLook(app: App): void {
    const { state, table } = app;
    const own = app.book?.presets(state.moment) ?? [];
    const names = own.map((one) => one.name);
    putOptions(
        element<HTMLSelectElement>('colors'),
        table && !names.includes(table.name) ? [table.name, ...names] : names,
        table?.name,
        tableTitle,
    );
    if (table) {
        const least = element<HTMLInputElement>('least');
        least.min = String(table.bar_begin);
        least.max = String(table.end);
        least.step = String((table.end - table.bar_begin) / 100);
        least.value = String(state.least ?? table.bar_begin);
    }
    const hidden = state.least === null ? '' : valueText(state.least, table?.unit ?? '', state.units);
    element('least-value').textContent = hidden || panelTexts.nothingHidden;
    element('least').setAttribute('aria-valuetext', hidden || panelTexts.nothingHidden);
    element<HTMLInputElement>('opacity').value = String(Math.log2(state.opacity));
    element('opacity').setAttribute('aria-valuetext', String(state.opacity));
    element<HTMLInputElement>('exaggeration').value = String(state.exaggeration);
    element('exaggeration-value').textContent = panelTexts.times(state.exaggeration);
    press('perspective', state.camera.fieldOfViewDeg > 0);
}

function addSliders(app: App, drawing: Drawing, editing: TableEditing): void {
    const slider = (id: string, take: (value: number) => void) =>
        element<HTMLInputElement>(id).addEventListener('input', (event) => {
            take(Number((event.target as HTMLInputElement).value));
            drawing.move();
            app.changed();
        });
    slider('least', (value) =>
        editing.hideBelow(value <= Number(element<HTMLInputElement>('least').min) ? null : value, 'threshold'),
    );
    element('least').addEventListener('change', () => editing.rest());
    slider('opacity', (value) => (app.state.opacity = Number((2 ** value).toFixed(3))));
    slider('exaggeration', (value) => (app.state.exaggeration = value));
}

// Adds the list of rungs (ways of drawing; renderer/ladder.ts). With its first entry, the page chooses the rung.
function addQuality(app: App): void {
    const select = element<HTMLSelectElement>('quality');
    select.append(
        new Option(panelTexts.asTimeAllows, ''),
        ...usualRungs.map(({ name, dE }) => new Option(panelTexts.rung(name, dE), name)),
    );
    select.addEventListener('change', () => {
        app.state.quality = select.value;
        app.changed();
    });
    const put = () => (select.value = app.state.quality);
    app.on('view', put);
    put();
}

// Returns true if the server keeps the shown grid, so that the server can fit a view to the grid.
function isStored({ shown }: App): boolean {
    return shown !== null && !shown.isBetween && !isRegion(shown.domain);
}

// Looks at the storms of the shown grid as `stormcellar frame` does.
async function fitStorms(app: App, drawing: Drawing): Promise<void> {
    const { shown } = app;
    if (!shown || !isStored(app)) return;
    app.showFlat(false);
    const geometry = drawing.geometry();
    if (!geometry) return;
    const { width, height } = geometry;
    try {
        const fitted = await fittedView(shown.domain, shown.moment, shown.time, width, height);
        if (app.shown?.domain !== shown.domain || app.state.isFlat) return;
        app.state.exaggeration = fitted.exaggeration;
        app.state.opacity = fitted.opacity;
        app.moved(cameraOfFitted(fitted, geometry.box, width, height));
        app.changed();
    } catch (error) {
        app.fail(error);
    }
}

export function openSettings(drawing: Drawing, isOpen: boolean): void {
    element('settings').hidden = !isOpen;
    element('open').setAttribute('aria-expanded', String(isOpen));
    drawing.draw();
}

export function addLook(app: App, drawing: Drawing, keys: Keys, editing: TableEditing): void {
    for (const [id, text] of [
        ['colors-name', panelTexts.colors],
        ['least-name', panelTexts.threshold],
        ['opacity-name', panelTexts.opacity],
        ['exaggeration-name', panelTexts.exaggeration],
        ['quality-name', panelTexts.quality],
    ] as const)
        element(id).textContent = text;
    for (const view of ['top', 'south', 'oblique'] as const) {
        element('views').append(button(`view-${view}`, panelTexts[view], () => keys.look(view)));
    }
    const fit = button('view-fitted', panelTexts.fitted, () => void fitStorms(app, drawing));
    element('views').append(fit);
    keys.add('z', () => void fitStorms(app, drawing));
    const mayFit = () => (fit.disabled = !isStored(app));
    app.on(['shown', 'view'], mayFit);
    mayFit();
    element('views').append(button('perspective', panelTexts.perspective, () => keys.togglePerspective()));
    element('colors').addEventListener('change', (event) => {
        editing.choosePreset((event.target as HTMLSelectElement).value);
    });
    addSliders(app, drawing, editing);
    addQuality(app);
    element('open').addEventListener('click', () => openSettings(drawing, element('settings').hidden));
    leaveByEscape(element('settings'), 'open', () => openSettings(drawing, false));
    keys.add('Escape', () => openSettings(drawing, false));
    app.on(['view', 'camera'], () => putLook(app));
    putLook(app);
}
