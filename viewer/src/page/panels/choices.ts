// Fills the head of the page: domains, title and messages.

import { GridFacts, Region, isRegion } from '../../wire/api';
import { isMoment, momentFacts, titleOf } from '../../wire/moments';
import { echoLayers, sweepMoment } from '../../scene/layers';
import { App } from '../app';
import { Drawing } from '../drawing';
import { button, element, make, press, putOptions } from '../dom';
import { FactsOfShown } from '../facts_of_shown';
import { healthOf } from '../health';
import { localText, newsS, texts } from '../texts';
import { addMoments } from './moment_choice';

function putDomains(app: App): void {
    const { state } = app;
    putOptions(
        element<HTMLSelectElement>('domain'),
        app.domains.map((one) => one.domain),
        state.domain,
        (name) => (isRegion(name) ? texts.start.region : name),
    );
}

const againAfterMs = 20_000; // between updates of ages

const scanS = 15 * 60; // no scan takes longer
const earlyMs = 15_000; // the first sweep may begin before the time of its volume

// Returns how many tilts of a volume are in its grid so far, and the highest. Leaves out sweeps of the volume before,
// which fill the rest of a growing grid.
function tiltsOf(facts: GridFacts | null, timeMs: number): { count: number; highestDeg: number } | null {
    const own = facts?.provenance.sweeps.filter(({ start }) => Date.parse(start) >= timeMs - earlyMs) ?? [];
    const angles = [...new Set(own.map((one) => one.elevation_deg.toFixed(1)))].map(Number);
    return angles.length === 0 ? null : { count: angles.length, highestDeg: Math.max(...angles) };
}

function putTitle(app: App, facts: FactsOfShown): void {
    const { shown } = app;
    if (!shown || app.isOnMap) return;
    const { domain } = shown;
    const { layers } = app.state;
    // If only a sweep is shown, its moment may differ from the moment of the grid.
    const isSweepAlone = layers.sweepDeg !== null && echoLayers(layers) === 1;
    const moment = isSweepAlone ? sweepMoment(layers, shown.moment) : shown.moment;
    const { grid } = shown.loaded;
    const names = grid.sites.map((site) => site.icao).join(', ');
    const place = (grid.sites.length === 1 && app.server.names.get(names)) || '';
    const time = new Date(grid.timeMs)
        .toISOString()
        .replace('T', ' ')
        .replace(/\.\d+Z/, ' UTC');
    const local = localText(grid.timeMs);
    const ageS = (app.server.nowMs - grid.timeMs) / 1000;
    const notes = [
        app.state.panes.length > 0 ? '' : titleOf(moment), // each pane has its own title
        grid.isPartial ? texts.partial(ageS < scanS, tiltsOf(facts.known, grid.timeMs)) : '',
        shown.isBetween ? texts.isBetween : '',
    ];
    // Put the age into a span of its own, which a saved picture leaves out.
    const age = make('span', {}, ageS >= 0 && ageS < newsS ? `  ${texts.start.age(ageS, '')}` : '');
    element('title').replaceChildren(
        [names, place, local === '' ? time : `${time} (${local})`, ...notes].filter(Boolean).join('  '),
        age,
    );
    document.title = `${domain} ${moment} ${time} · ${texts.title}`;
}

// Shows problems of the server, of radars and of the request until they are over.
function putNotice(app: App): void {
    const sites = app.shown?.loaded.grid.sites.map((site) => site.icao) ?? [];
    const silences = sites
        .map((site) => ({ site, silentS: (app.server.nowMs - (app.server.silentSince.get(site) ?? -Infinity)) / 1000 }))
        .filter(({ silentS }) => silentS < newsS);
    const silent = silences.map(({ site, silentS }) => texts.notice.silent(site, silentS));
    const text = [
        app.isGraphicsLost ? texts.notice.noGraphics : '',
        app.server.isCutOff ? texts.notice.noServer : '',
        app.missed,
        ...silent,
    ]
        .filter(Boolean)
        .join(' ');
    for (const id of ['notice', 'start-notice']) if (element(id).textContent !== text) element(id).textContent = text;
    document.documentElement.classList.toggle('lost', app.isGraphicsLost);
    element('reload').hidden = !app.isGraphicsLost;
    const ageS = (app.server.nowMs - Date.parse(app.timeline.newest ?? '')) / 1000;
    const silentS = silences.length > 0 ? Math.max(...silences.map((one) => one.silentS)) : null;
    const { level, text: told } = healthOf(ageS, silentS, app.server.isCutOff);
    press('follow', app.player.follows && level !== 'silent');
    element('follow').dataset['health'] = level;
    if (element('follow').textContent !== told) element('follow').textContent = told;
}

// Shows when each radar in the picture scanned, and why other radars of the region are not in it.
function putSites(app: App, { sites }: FactsOfShown): void {
    const box = element('sites-told');
    const { shown } = app;
    const inPicture = shown?.loaded.grid.sites.map((site) => site.icao) ?? [];
    const ofSites = (sites?.sites ?? [])
        .filter(({ site }) => inPicture.includes(site))
        .map(({ site, volumes }) => ({ site, middlesS: volumes.map((one) => one.middle_s) }));
    const region =
        shown && isRegion(shown.domain)
            ? (app.domain as Region).moments.find((one) => one.moment === shown.moment)
            : undefined;
    const without = [...(region?.sites ?? []), ...(region?.left_out ?? [])].filter((site) => !inPicture.includes(site));
    const isSigned = isMoment(shown?.moment ?? '') && momentFacts(shown?.moment ?? '').isSigned;
    const told = [
        texts.start.sitesAt(ofSites),
        without.length > 0
            ? texts.start.leftOut(without.map((site) => [site, sites?.left_out_because[site] ?? '']))
            : '',
        region && region.halved > 0 ? texts.start.halved(region.halved) : '',
        inPicture.length > 1 && isSigned ? texts.start.ownVelocities : '',
    ];
    box.textContent = told.filter(Boolean).join('; ');
    box.hidden = box.textContent === '';
}

// Names the shown layers.
function putLayers({ layers }: Drawing): void {
    const told = layers.told();
    element('layers-told').textContent = told.join(' · ');
    element('layers-told').hidden = told.length === 0;
}

export function addChoices(app: App, drawing: Drawing, facts: FactsOfShown): void {
    element('title').after(make('p', { id: 'layers-told', hidden: '' }), make('p', { id: 'sites-told', hidden: '' }));
    element('notice').after(button('reload', texts.notice.reload, () => location.reload()));
    element('reload').hidden = true;
    addMoments(app);
    app.on('choices', () => putDomains(app));
    app.on(['notice', 'time', 'shown', 'map'], () => putNotice(app));
    const askSites = () =>
        void facts.askSites().then(
            () => putSites(app, facts),
            () => undefined,
        );
    window.setInterval(() => {
        askSites();
        putTitle(app, facts);
        putNotice(app);
    }, againAfterMs);
    app.on(['shown', 'view', 'notice'], () => putTitle(app, facts));
    app.on('shown', () => {
        // Only the facts tell the tilts of an incomplete volume.
        if (app.shown?.loaded.grid.isPartial && !isRegion(app.shown.domain))
            facts.ask().then(
                () => putTitle(app, facts),
                () => undefined,
            );
    });
    app.on(['view', 'shown', 'choices', 'units'], () => putLayers(drawing));
    drawing.share.layerCame.push(() => putLayers(drawing));
    app.on('shown', () => {
        putSites(app, facts);
        askSites();
    });
    element<HTMLSelectElement>('domain').addEventListener(
        'change',
        (event) => void app.chooseDomain((event.target as HTMLSelectElement).value),
    );
}
