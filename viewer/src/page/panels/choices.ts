// Fills the head of the page: domains, title and messages.

import { toleratedFutureMs } from '../../time/timeline';
import { Region, isRegion } from '../../wire/api';
import { isMoment, momentFacts, titleOf } from '../../wire/moments';
import { echoLayers, sweepMoment } from '../../scene/layers';
import { App } from '../app';
import { Drawing } from '../drawing';
import { button, element, make, press, putOptions } from '../dom';
import { FactsOfShown } from '../facts_of_shown';
import { newsS, texts } from '../texts';
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

const liveS = 30 * 60; // no radar takes so long from one volume to the next
const againAfterMs = 20_000; // between updates of ages

function putTitle(app: App): void {
    const { shown } = app;
    if (!shown || app.isOnMap) return;
    const { domain } = shown;
    const { layers } = app.state;
    // A sweep alone may be of another moment than the grid.
    const isSweepAlone = layers.sweepDeg !== null && echoLayers(layers) === 1;
    const moment = isSweepAlone ? sweepMoment(layers, shown.moment) : shown.moment;
    const { grid } = shown.loaded;
    const names = grid.sites.map((site) => site.icao).join(', ');
    const time = new Date(grid.timeMs)
        .toISOString()
        .replace('T', ' ')
        .replace(/\.\d+Z/, ' UTC');
    const ageS = (app.server.nowMs - grid.timeMs) / 1000;
    const notes = [titleOf(moment), grid.isPartial ? texts.partial : '', shown.isBetween ? texts.isBetween : ''];
    // Put the age into a span of its own, which a saved picture leaves out.
    const age = make('span', {}, ageS >= 0 && ageS < newsS ? `  ${texts.start.age(ageS, '')}` : '');
    element('title').replaceChildren([names, time, ...notes.filter((note) => note !== '')].join('  '), age);
    document.title = `${domain} ${moment} ${time} · ${texts.title}`;
}

// Shows problems of the server, of radars and of the request until they are over.
function putNotice(app: App): void {
    const sites = app.shown?.loaded.grid.sites.map((site) => site.icao) ?? [];
    const silent = sites.flatMap((site) => {
        const sinceMs = app.server.silentSince.get(site);
        const ageS = sinceMs === undefined ? Infinity : (app.server.nowMs - sinceMs) / 1000;
        return ageS < newsS ? [texts.notice.silent(site, ageS)] : [];
    });
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
    press('follow', app.player.follows && !app.server.isCutOff && silent.length === 0);
    const ageMs = app.server.nowMs - Date.parse(app.timeline.newest ?? '');
    const isLive = ageMs >= -toleratedFutureMs && ageMs < 1000 * liveS;
    element('follow').textContent = isLive ? texts.live : texts.latest;
}

// Shows when each site of a region was seen, and why other sites are not in the picture.
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
        putTitle(app);
        putNotice(app);
    }, againAfterMs);
    app.on(['shown', 'view'], () => putTitle(app));
    app.on(['view', 'shown', 'choices', 'units'], () => putLayers(drawing));
    drawing.layers.layerCame.push(() => putLayers(drawing));
    app.on('shown', () => {
        putSites(app, facts);
        askSites();
    });
    element<HTMLSelectElement>('domain').addEventListener(
        'change',
        (event) => void app.chooseDomain((event.target as HTMLSelectElement).value),
    );
}
