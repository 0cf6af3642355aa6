// Adds the button and the key that open the map of all stations. Loads the program of the map when the map is opened
// first.

import { App } from '../app';
import { button, element } from '../dom';
import { Keys } from '../keys';
import { laterProgram } from '../later_program';
import { texts } from '../texts';

export function addMap(app: App, keys: Keys): void {
    element('head').prepend(button('to-map', texts.start.toMap, () => app.goToMap()));
    keys.add('h', () => app.goToMap());
    let loading: Promise<void> | null = null;
    const load = async (): Promise<void> => {
        const { StartMap } = await laterProgram<typeof import('./start_map')>('map');
        new StartMap(app).begin();
    };
    app.on('map', () => {
        if (!app.isOnMap || loading) return;
        loading = load().catch((error: unknown) => {
            loading = null;
            app.fail(error);
        });
    });
}
