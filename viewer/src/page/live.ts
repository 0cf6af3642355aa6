// What the server tells of new and changed grids.

import { address } from '../wire/api';
import { App } from './app';

interface News {
    domain?: string;
    moment?: string;
    grid?: string; // its time
}

export function hear(app: App): void {
    const events = new EventSource(address('api/v1/events'));
    for (const kind of ['sweep_gridded', 'volume_complete', 'mosaic', 'grid_evicted']) {
        events.addEventListener(kind, event => {
            const { domain, moment, grid } = JSON.parse((event as MessageEvent<string>).data) as News;
            app.takeNews(domain, moment, grid).catch(error => app.fail(error));
        });
    }
}
