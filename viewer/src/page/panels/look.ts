// How the volume is shown: colors, threshold, opacity, heights, and from where.

import { valueText } from '../../tables/units';
import { App } from '../app';
import { button, element, press, putOptions } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { texts } from '../texts';

function putLook(app: App): void {
    const { state, table } = app;
    const own = app.tables.tables.filter(one => one.moment === state.moment);
    putOptions(
        element<HTMLSelectElement>('colors'),
        own.map(one => one.name),
        table?.name,
    );
    if (table) {
        const least = element<HTMLInputElement>('least');
        least.min = String(table.bar_begin);
        least.max = String(table.end);
        least.step = String((table.end - table.bar_begin) / 100);
        least.value = String(state.least ?? table.bar_begin);
    }
    element('least-value').textContent = state.least === null ? '' : valueText(state.least, table?.unit ?? '', state.units);
    element<HTMLInputElement>('opacity').value = String(Math.log2(state.opacity));
    element<HTMLInputElement>('exaggeration').value = String(state.exaggeration);
    press('perspective', state.camera.fieldOfViewDeg > 0);
}

function addSliders(app: App, drawing: Drawing): void {
    const slider = (id: string, take: (value: number) => void) =>
        element<HTMLInputElement>(id).addEventListener('input', event => {
            take(Number((event.target as HTMLInputElement).value));
            drawing.move();
            app.changed();
        });
    slider('least', value => (app.state.least = value <= Number(element<HTMLInputElement>('least').min) ? null : value));
    slider('opacity', value => (app.state.opacity = Number((2 ** value).toFixed(3))));
    slider('exaggeration', value => (app.state.exaggeration = value));
}

export function openSettings(drawing: Drawing, isOpen: boolean): void {
    element('settings').hidden = !isOpen;
    element('open').setAttribute('aria-expanded', String(isOpen));
    drawing.draw();
}

export function addLook(app: App, drawing: Drawing, keys: Keys): void {
    for (const [id, text] of [
        ['colors-name', texts.colors],
        ['least-name', texts.threshold],
        ['opacity-name', texts.opacity],
        ['exaggeration-name', texts.exaggeration],
        ['open', texts.settings],
    ] as const)
        element(id).textContent = text;
    for (const view of ['top', 'south', 'oblique'] as const) {
        element('views').append(button(`view-${view}`, texts[view], () => keys.look(view)));
    }
    element('views').append(button('perspective', texts.perspective, () => keys.togglePerspective()));
    element('colors').addEventListener('change', event => {
        app.state.colors = (event.target as HTMLSelectElement).value;
        app.changed();
    });
    addSliders(app, drawing);
    element('open').addEventListener('click', () => openSettings(drawing, element('settings').hidden));
    keys.add('Escape', () => openSettings(drawing, false));
    app.on('view', () => putLook(app));
    app.on('camera', () => putLook(app));
}
