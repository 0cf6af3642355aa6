// Adds the buttons that switch between 2D and 3D.

import { App } from '../app';
import { button, element, make, press } from '../dom';
import { Drawing } from '../drawing';
import { texts } from '../texts';

export function addMode(app: App, drawing: Drawing): void {
    const modes = [
        ['mode-2d', texts.mode.flat, texts.mode.flatTold, true],
        ['mode-3d', texts.mode.solid, texts.mode.solidTold, false],
    ] as const;
    const buttons = modes.map(([id, text, told, isFlat]) => {
        const made = button(id, text, () => app.showFlat(isFlat));
        made.title = told;
        return made;
    });
    const choice = make('div', { id: 'mode', role: 'group', 'aria-label': texts.mode.name }, ...buttons);
    drawing.labels.after(make('div', { id: 'sight' }, choice));
    const put = () => {
        for (const [id, , , isFlat] of modes) press(id, app.state.isFlat === isFlat);
        document.body.classList.toggle('flat', app.state.isFlat);
        element('picture').setAttribute('aria-label', app.state.isFlat ? texts.mode.flatPicture : texts.mode.picture);
    };
    app.on(['view', 'choices'], put);
    put();
}
