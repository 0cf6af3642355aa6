// Adds the list with which the user chooses the number of panes, or panes of usual moments or tilts.

import { PaneCount, paneCounts, paneList, panesOfMoments, panesOfTilts, presetMoments } from '../../scene/panes';
import { tiltsOf } from '../../fields/sweep_choice';
import { sweepMoment } from '../../scene/layers';
import { App } from '../app';
import { element, make } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { panelTexts } from '../later_texts';

const words = panelTexts.panes;
const usualTiltsDeg = [0.5, 1.5, 2.4, 3.4]; // until the cuts of the volume have come

const countOf = ({ state }: App): PaneCount => paneCounts.find((count) => count === state.panes.length) ?? 1;

function showCount(app: App, count: PaneCount): void {
    const { state } = app;
    app.usePanes(paneList(state, count), state.active < count ? state.active : 0);
}

function showMoments(app: App): void {
    const inDomain = (app.domain?.moments ?? []).map(({ moment }) => moment);
    const moments = presetMoments(4, inDomain, words.choices.moments.split(' '));
    app.usePanes(panesOfMoments(app.state, moments), Math.max(0, moments.indexOf(app.state.moment)));
}

// Shows the four lowest tilts in 2D.
function showTilts(app: App, drawing: Drawing): void {
    app.showFlat(true);
    const { state, shown } = app;
    const moment = sweepMoment(state.layers, shown?.moment ?? state.moment);
    const tilts = tiltsOf(drawing.layers.sweepRows() ?? [], moment).map((cuts) =>
        Number(cuts[0]!.elevation_deg.toFixed(2)),
    );
    const elevations = [...tilts, ...usualTiltsDeg.filter((deg) => deg > (tilts[tilts.length - 1] ?? -1))].slice(0, 4);
    app.usePanes(panesOfTilts(state, elevations), 0);
}

export function addPaneChoice(app: App, drawing: Drawing, keys: Keys): void {
    const select = make('select', { id: 'pane-choice', 'aria-label': words.name, title: words.tip });
    for (const [value, text] of Object.entries(words.choices)) select.append(new Option(text, value));
    element('mode').after(make('div', {}, select));
    const put = () => (select.value = String(countOf(app)));
    select.addEventListener('change', () => {
        if (select.value === 'moments') showMoments(app);
        else if (select.value === 'tilts') showTilts(app, drawing);
        else showCount(app, Number(select.value) as PaneCount);
        put();
    });
    keys.add('4', () => showCount(app, paneCounts[(paneCounts.indexOf(countOf(app)) + 1) % paneCounts.length]!));
    keys.add('5', () => {
        const { panes, pane } = drawing;
        const next = panes.map((_, i) => (pane.index + 1 + i) % panes.length).find((i) => panes[i]!.shown);
        if (next !== undefined) drawing.activate(next);
    });
    app.on(['view', 'choices'], put);
    put();
}
