// Loads the program of the section's plot, of beam glyphs, of rotation and of storm cells when one of them is shown
// first.

import { App } from '../app';
import { Drawing } from '../drawing';
import { laterProgram } from '../later_program';

export function loadLayers(app: App, drawing: Drawing): void {
    let isLoaded = false;
    const need = async (): Promise<void> => {
        const { section, hasGlyphs, hasRotation, hasCells } = app.state.layers;
        if (isLoaded || !(section || hasGlyphs || hasRotation || hasCells)) return;
        isLoaded = drawing.isLoadingLayers = true;
        try {
            const program = await laterProgram<typeof import('./later_layers')>('layers');
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
