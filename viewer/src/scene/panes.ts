// Holds the panes of a view. Panes share domain, time, camera, heights and opacity; each has its own moment, layers,
// threshold and table. One pane is active: the view has its values, and controls change them.

import { momentsInOrder } from '../wire/moments';
import { Layers, flatLayers, layersAddress, layersOf } from './layers';

export interface PaneView {
    moment: string;
    layers: Layers;
    least: number | null; // values below it are not shown
    colors: string; // name of a table; empty: the moment's own table
}

// A view with panes. `panes` is empty if there is one pane. Otherwise the entry of the active pane may be outdated.
export interface Panes extends PaneView {
    panes: readonly PaneView[];
    active: number;
}

export type PaneCount = 1 | 2 | 4;
export const paneCounts: readonly PaneCount[] = [1, 2, 4];

const ownOf = ({ moment, layers, least, colors }: PaneView): PaneView => ({ moment, layers, least, colors });

// Returns all panes, at least one.
export const allPanes = (view: Panes): PaneView[] =>
    view.panes.length === 0 ? [ownOf(view)] : view.panes.map((pane, i) => ownOf(i === view.active ? view : pane));

// Returns the parts of a view with these panes.
export const withPanes = (all: readonly PaneView[], active: number): Panes => ({
    ...all[active]!,
    panes: all.length > 1 ? all : [],
    active,
});

// Returns the panes with other layers.
export const withLayers = (view: Panes, change: (layers: Layers, index: number) => Layers): PaneView[] =>
    allPanes(view).map((pane, i) => ({ ...pane, layers: change(pane.layers, i) }));

// Returns a number of panes, of which the first are the panes of the view. New panes show what the active pane shows.
export function paneList(view: Panes, count: PaneCount): PaneView[] {
    const all = allPanes(view);
    const isActiveKept = view.active < count;
    return Array.from({ length: count }, (_, i) => (i === 0 && !isActiveKept ? ownOf(view) : (all[i] ?? ownOf(view))));
}

// Returns the moments of a number of panes: the usual ones, and others of the domain in place of those that it lacks.
export function presetMoments(count: PaneCount, inDomain: readonly string[], usualMoments: string[]): string[] {
    const others = momentsInOrder(inDomain.filter((one) => !usualMoments.includes(one)))
        .filter(({ isThere }) => isThere)
        .map(({ moment }) => moment);
    const found = [...usualMoments.filter((one) => inDomain.includes(one)), ...others];
    return Array.from({ length: count }, (_, i) => found[i] ?? found[0] ?? '');
}

// Returns panes with the layers of the active pane and these moments.
export const panesOfMoments = (view: Panes, moments: readonly string[]): PaneView[] =>
    moments.map((moment) =>
        moment === view.moment
            ? ownOf(view)
            : { moment, layers: { ...view.layers, sweepNumber: null }, least: null, colors: '' },
    );

// Returns panes that show one moment at these elevations in 2D.
export const panesOfTilts = (view: Panes, elevationsDeg: readonly number[]): PaneView[] =>
    elevationsDeg.map((sweepDeg) => ({
        ...ownOf(view),
        layers: { ...flatLayers(view.layers), sweepDeg, sweepNumber: null },
    }));

// -- the address

const escaped = (text: string): string => text.replace(/[%;=&+]/g, encodeURIComponent);

// Returns a pane as "MOMENT;name=text;...", with the names of the address.
export function paneText({ moment, layers, least, colors }: PaneView, isFlat: boolean): string {
    const parts: [string, string][] = [];
    if (least !== null) parts.push(['least', String(Number(least.toFixed(4)))]);
    if (colors) parts.push(['colors', colors]);
    parts.push(...layersAddress(layers));
    if (isFlat && layers.hasVolume) parts.push(['volume', '1']);
    return [escaped(moment), ...parts.map(([name, text]) => `${name}=${escaped(text)}`)].join(';');
}

// Reads the part of a view that each pane has of its own. A parameter that makes no sense keeps its usual value.
export function paneOfQuery(query: URLSearchParams, isFlat: boolean): PaneView {
    const leastText = query.get('least') ?? '';
    const least = leastText === '' ? NaN : Number(leastText);
    return {
        moment: (query.get('moment') ?? '').toUpperCase().slice(0, 8),
        layers: isFlat && !query.has('volume') ? flatLayers(layersOf(query)) : layersOf(query),
        least: Math.abs(least) <= 1000 ? least : null,
        colors: (query.get('colors') ?? '').slice(0, 100),
    };
}

function paneOfText(text: string, isFlat: boolean): PaneView {
    const [moment = '', ...parts] = text.slice(0, 1000).split(';');
    return paneOfQuery(new URLSearchParams(`moment=${moment}&${parts.join('&')}`), isFlat);
}

// Returns the panes of an address: the first has the parameters of a view with one pane, and the others have one
// parameter each. There are 1, 2 or 4 panes, so one of two others is left out.
export function panesOfQuery(query: URLSearchParams, isFlat: boolean): Panes {
    const first = paneOfQuery(query, isFlat);
    const others = query.getAll('pane');
    const count = others.length === 0 ? 1 : others.length < 3 ? 2 : 4;
    const all = [first, ...others.slice(0, count - 1).map((text) => paneOfText(text, isFlat))];
    const active = Number(query.get('active') ?? '1') - 1;
    return withPanes(all, Number.isInteger(active) && active >= 0 && active < all.length ? active : 0);
}
