// Taking along what is shown: the address, the command that draws the same, the picture, the grid.

import { commandOf } from '../../scene/view_state';
import { address, gridPath, isRegion } from '../../wire/api';
import { App } from '../app';
import { button, element, saveFile } from '../dom';
import { Drawing } from '../drawing';
import { snapshotOf } from '../snapshot';
import { TableEditing } from '../table_editing';
import { texts } from '../texts';

// Browsers give no clipboard to pages that came over plain HTTP from another machine.
function copy(app: App, text: string, said: string): void {
    const clipboard: Clipboard | undefined = navigator.clipboard;
    (clipboard ? clipboard.writeText(text) : Promise.reject(new Error('no clipboard'))).then(
        () => app.say(said),
        () => window.prompt(said, text),
    );
}

function save(app: App, drawing: Drawing): void {
    const link = document.createElement('a');
    link.download = `${app.state.domain}_${app.state.moment}_${(app.shown?.time ?? '').replace(/:/g, '')}.png`;
    link.href = snapshotOf(drawing.picture, drawing.labels, app.state.moment).toDataURL('image/png');
    link.click();
}

const savedFiles = new Set<string>(); // of commands that were copied

// Colors that no table of the program has are in a file that the command names.
function copyCommand(app: App, drawing: Drawing, editing: TableEditing): void {
    const { width, height } = drawing.picture;
    const { state } = app;
    const preset = app.book?.presets(state.moment).some(table => table.name === state.colors) ? state.colors : '';
    if (!editing.isEdited && state.least === null) return copy(app, commandOf(state, width, height, preset), texts.commandCopied);
    const file = editing.tomlForCommand();
    if (!savedFiles.has(file.name)) saveFile(file.name, file.text);
    savedFiles.add(file.name);
    copy(app, commandOf(state, width, height, file.name), texts.commandWithFile(file.name));
}

export function addShare(app: App, drawing: Drawing, editing: TableEditing): void {
    element('actions').append(
        button('share', texts.share, () => copy(app, app.link, texts.shared)),
        button('save', texts.save, () => save(app, drawing)),
        button('command', texts.command, () => copyCommand(app, drawing, editing)),
        button('netcdf', texts.netcdf, () => {
            const { shown } = app;
            if (!shown) return;
            if (isRegion(shown.domain) || app.isBetween(shown.time)) return app.say(texts.noNetcdf);
            location.href = address(`${gridPath(shown.domain, shown.moment, shown.time)}/netcdf`);
        }),
    );
}
