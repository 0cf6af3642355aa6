// Adds the buttons that open settings, layers and the cuts of the scan. Loads the program of panels, tools and readings
// once the first picture is there, or when the user asks for one of them earlier.

import { afterPictureMs, button, element } from '../dom';
import { laterProgram } from '../later_program';
import { texts } from '../texts';
import type { PageParts } from './later_panels';

export function addPanels(parts: PageParts): void {
    const { app, drawing, keys } = parts;
    const settings = element('open');
    settings.textContent = texts.settings;
    settings.setAttribute('aria-expanded', 'false');
    const early: HTMLElement[] = []; // buttons that were pressed before the program came
    const [layers, scan] = (
        [
            ['layers', texts.layers.title],
            ['scan', texts.scan],
        ] as const
    ).map(([id, text]) => {
        const opener = button(`${id}-open`, text, () => undefined);
        opener.setAttribute('aria-controls', id);
        opener.setAttribute('aria-expanded', 'false');
        return opener;
    }) as [HTMLButtonElement, HTMLButtonElement];
    settings.after(layers, scan);
    let loading: Promise<void> | null = null;
    let isLoaded = false;
    const load = async (): Promise<void> => {
        const program = await laterProgram<typeof import('./later_panels')>('panels');
        isLoaded = true;
        program.begin(parts);
        keys.complete();
        for (const opener of early.slice(-1)) opener.click();
        drawing.drawMarks();
        document.documentElement.dataset['panels'] = 'loaded';
    };
    const need = (): void => {
        if (loading) return;
        loading = load().catch((error: unknown) => {
            loading = null;
            app.fail(error);
        });
    };
    for (const opener of [settings, layers, scan])
        opener.addEventListener('click', () => {
            if (isLoaded) return;
            early.push(opener);
            need();
        });
    keys.onEarly = need;
    document.addEventListener('dragenter', need); // a file may be dropped
    drawing.pictureFinished.push(() => window.setTimeout(need, afterPictureMs));
}
