// The head of the page: domain, moments, and what is shown.

import { isRegion } from '../../wire/api';
import { App } from '../app';
import { button, element, press, putOptions } from '../dom';
import { texts } from '../texts';

function putChoices(app: App): void {
    const { state, domain } = app;
    putOptions(
        element<HTMLSelectElement>('domain'),
        app.domains.map(one => one.domain),
        state.domain,
        name => (isRegion(name) ? texts.start.region : name),
    );
    element('moments').replaceChildren(
        ...(domain?.moments ?? []).map(({ moment }) => button(`moment-${moment}`, moment, () => void app.choose(state.domain, moment))),
    );
    for (const { moment } of domain?.moments ?? []) press(`moment-${moment}`, moment === state.moment);
}

function putTitle(app: App): void {
    const { grid } = app.shown!.loaded;
    const names = grid.sites.map(site => site.icao).join(', ');
    const time = new Date(grid.timeMs).toISOString().replace('T', ' ').replace(/\.\d+Z/, ' UTC');
    const notes = [grid.isPartial ? texts.partial : '', app.isBetween(app.shown!.time) ? texts.isBetween : ''];
    element('title').textContent = [names, time, ...notes.filter(note => note !== '')].join('  ');
    document.title = `${app.state.domain} ${app.state.moment} ${time} · ${texts.title}`;
}

export function addChoices(app: App): void {
    app.on('choices', () => putChoices(app));
    app.on('shown', () => putTitle(app));
    element<HTMLSelectElement>('domain').addEventListener('change', event => void app.chooseDomain((event.target as HTMLSelectElement).value));
}
