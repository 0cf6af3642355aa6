// Loads the program of the section's plot, of beam glyphs, of rotation and of storm cells when one of them is shown
// first.

import { address } from '../../wire/api';
import { App } from '../app';
import { Drawing } from '../drawing';

export function loadLayers(app: App, drawing: Drawing): void {
    let isLoaded = false;
    const need = async (): Promise<void> => {
        const { section, hasGlyphs, hasRotation, hasCells } = app.state.layers;
        if (isLoaded || !(section || hasGlyphs || hasRotation || hasCells)) return;
        isLoaded = drawing.isLoadingLayers = true;
        try {
            const program = (await import(address('view/layers.js'))) as typeof import('./later_layers');
            program.begin(app, drawing);
        } catch (error) {
            isLoaded = false;
            app.fail(error);
        }
        drawing.isLoadingLayers = false;
        drawing.draw();
    };
    app.on(['view', 'shown'], () => void need());
    void need();
}
