// Taking along what is shown: the address, the command that draws the same, the picture, the grid.

import { commandOf } from '../../scene/view_state';
import { address, gridPath } from '../../wire/api';
import { App } from '../app';
import { button, element } from '../dom';
import { Drawing } from '../drawing';
import { texts } from '../texts';

function copy(app: App, text: string, said: string): void {
    navigator.clipboard.writeText(text).then(
        () => app.say(said),
        () => window.prompt(said, text),
    );
}

function save(app: App, drawing: Drawing): void {
    const link = document.createElement('a');
    link.download = `${app.state.domain}_${app.state.moment}_${(app.shown?.time ?? '').replace(/:/g, '')}.png`;
    link.href = drawing.snapshot().toDataURL('image/png');
    link.click();
}

export function addShare(app: App, drawing: Drawing): void {
    const { picture } = drawing;
    element('actions').append(
        button('share', texts.share, () => copy(app, location.href, texts.shared)),
        button('save', texts.save, () => save(app, drawing)),
        button('command', texts.command, () => copy(app, commandOf(app.state, picture.width, picture.height), texts.commandCopied)),
        button('netcdf', texts.netcdf, () => {
            if (app.shown) location.href = address(`${gridPath(app.shown.domain, app.shown.moment, app.shown.time)}/netcdf`);
        }),
    );
}
