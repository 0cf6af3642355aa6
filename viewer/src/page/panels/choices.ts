// The head of the page: domain, moments, and what is shown.

import { isRegion } from '../../wire/api';
import { App } from '../app';
import { button, element, press, putOptions } from '../dom';
import { FactsOfShown } from '../facts_of_shown';
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

// When each site of a region was seen.
function putSites({ sites }: FactsOfShown): void {
    const box = element('sites-told');
    box.textContent = texts.start.sitesAt((sites ?? []).map(({ site, volumes }) => ({ site, middlesS: volumes.map(one => one.middle_s) })));
    box.hidden = sites === null;
}

export function addChoices(app: App, facts: FactsOfShown): void {
    const sites = document.createElement('p');
    sites.id = 'sites-told';
    sites.hidden = true;
    element('title').after(sites);
    app.on('choices', () => putChoices(app));
    app.on('shown', () => {
        putTitle(app);
        putSites(facts);
        void facts.askSites().then(() => putSites(facts), () => undefined);
    });
    element<HTMLSelectElement>('domain').addEventListener('change', event => void app.chooseDomain((event.target as HTMLSelectElement).value));
}
