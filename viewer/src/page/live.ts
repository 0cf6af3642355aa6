// What the server tells of new and changed grids, and whether it still tells anything.

import { address } from '../wire/api';
import { App } from './app';

interface News {
    domain?: string;
    moment?: string;
    grid?: string; // its time
    station?: string;
    silent_s?: number;
}

const againAfterMs = 5000; // where the browser does not connect again by itself

export function hear(app: App): void {
    const events = new EventSource(address('api/v1/events'));
    const listen = (kind: string, take: (news: News) => void) =>
        events.addEventListener(kind, event => take(JSON.parse((event as MessageEvent<string>).data) as News));
    // What came meanwhile is not told to a new listener, nor after a reset.
    const catchUp = () => void app.catchUp().catch(error => app.fail(error));
    for (const kind of ['sweep_gridded', 'volume_complete', 'mosaic', 'grid_evicted']) {
        listen(kind, ({ domain, moment, grid }) => void app.takeNews(domain, moment, grid).catch(error => app.fail(error)));
    }
    listen('station_silent', ({ station, silent_s }) => app.takeSilence(station ?? '', silent_s ?? 0));
    listen('station_spoke', ({ station }) => app.takeSilence(station ?? '', null));
    listen('reset', catchUp);
    events.addEventListener('open', () => {
        if (app.isCutOff || !app.book) catchUp();
        app.takeServer(true);
    });
    events.addEventListener('error', () => {
        app.takeServer(false);
        if (events.readyState !== EventSource.CLOSED) return;
        window.setTimeout(() => hear(app), againAfterMs);
    });
}
