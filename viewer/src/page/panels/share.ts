// Adds the buttons that copy or save the view: as a link, a command, a picture, or a grid.

import { beyondCommand } from '../../scene/layers';
import { isPrintable } from '../../scene/shell';
import { commandOf, isBeyondLimits, isUsualGrid } from '../../scene/view_state';
import { LoadedGrid } from '../../atlas/loaded_grid';
import { address, gridPath, isRegion, rawAt } from '../../wire/api';
import { App } from '../app';
import { button, element, make, saveFile } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { snapshotOf, snapshotOfPanes } from '../snapshot';
import { TableEditing } from '../table_editing';
import { panelTexts } from '../later_texts';

// Copies a text, and says so. Browsers give no clipboard to pages from another machine over plain HTTP; the user then
// copies the text from a dialog.
function copy(app: App, text: string, said: string, ...notes: string[]): void {
    const { clipboard } = navigator as Partial<Navigator>;
    (clipboard ? clipboard.writeText(text) : Promise.reject(new Error('no clipboard'))).then(
        () => app.say([said, ...notes].join(' ')),
        () => window.prompt([panelTexts.copyByHand, ...notes].join(' '), text),
    );
}

// Saves the next fine picture. Names the picture by its own domain, moment and time, because another picture may be
// loading already.
function save(app: App, drawing: Drawing): void {
    app.say(panelTexts.saving);
    drawing.whenFine(
        () => {
            if (!app.shown) return;
            const { domain, time } = app.shown;
            const { panes, picture, labels } = drawing;
            const moments = panes.map(({ shown }) => shown?.moment).filter(Boolean);
            const download = `${domain}_${moments.join('-')}_${time.replace(/:/g, '')}.png`;
            const heads = [...document.querySelectorAll<HTMLElement>('.pane')];
            const taken = panes.length > 1 ? snapshotOfPanes(picture, labels, heads) : snapshotOf(picture, labels);
            const href = taken.toDataURL('image/png');
            make('a', { download, href }).click();
        },
        () => app.say(panelTexts.notSaved),
    );
}

const savedFiles = new Set<string>(); // names of the files of colors that were saved for commands

// Finds the raw file of the grid, if there is just one. A command that reads this file needs no cache. The page asks
// for the file before a click on the button, because browsers allow copying only directly after a click.
class RawFile {
    private of: LoadedGrid | null = null;
    private name = '';
    number = 1; // number of the volume in the file

    constructor(
        private app: App,
        private facts: FactsOfShown,
    ) {}

    // Returns the name of the file; an empty text if there is none, or if the shown grid is not the usual grid. The
    // command makes the usual grid of a file, which may show another area than the shown grid.
    get known(): string {
        const loaded = this.app.shown?.loaded;
        return loaded && this.of === loaded && isUsualGrid(loaded.grid) && isPrintable(this.name) ? this.name : '';
    }
    async ask(): Promise<void> {
        const { shown } = this.app;
        if (!shown || this.of === shown.loaded || isRegion(shown.domain) || shown.isBetween) return;
        const { provenance } = await this.facts.ask();
        // Check the domain, because a mosaic may have a single station at some instants.
        const isOne =
            provenance.source_files.length === 1 &&
            provenance.stations.length === 1 &&
            provenance.stations[0] === shown.domain;
        const volume = isOne ? await rawAt(shown.domain, shown.time) : null;
        if (shown !== this.app.shown) return;
        [this.of, this.name, this.number] = [shown.loaded, volume?.raw ?? '', volume?.number_in_file ?? 1];
    }
}

// Returns the reason why no command draws the view; an empty text if a command does.
function whyNoCommand(app: App, drawing: Drawing): string {
    const { shown, state } = app;
    const words = panelTexts.noCommand;
    if (!shown) return words.nothing;
    if (shown.domain !== state.domain || shown.moment !== state.moment) return words.coming;
    if (isRegion(shown.domain)) return words.region;
    if (!isPrintable(shown.domain)) return words.name;
    if (shown.isBetween) return words.between;
    if (!state.hasGround) return words.ground;
    const beyond = beyondCommand(state.layers, shown.loaded.grid.sites.length);
    if (beyond) return words[beyond];
    if (drawing.drawn?.hasFolded && drawing.drawn.air?.hasFolded) return words.veil;
    const size = drawing.geometry();
    if (isBeyondLimits(state, size?.width ?? 0, size?.height ?? 0)) return words.limits;
    return state.layers.sweepDeg !== null && !drawing.layers.shownCut() ? words.noSweep : '';
}

// Copies the command that draws the view in the size of the page. The command names the shown time even if the page
// follows the newest. If the user edited the colors or set a threshold, saves the shown table in a file that the
// command names.
function copyCommand(app: App, drawing: Drawing, editing: TableEditing, rawFile: RawFile): void {
    const why = whyNoCommand(app, drawing);
    const size = drawing.geometry();
    if (why || !size || !app.shown) return app.say(why);
    const { domain, moment, time } = app.shown;
    // Name the drawn cut by its number.
    const layers = { ...app.state.layers, sweepNumber: drawing.layers.shownCut()?.sweep ?? null };
    const state = { ...app.state, domain, moment, time, layers };
    const raw = rawFile.known;
    const notes = [raw ? panelTexts.commandReads(raw) : panelTexts.commandReadsCache];
    if (!state.layers.hasVolume && !state.layers.section) notes.push(panelTexts.commandFlat);
    if (drawing.panes.length > 1) notes.push(panelTexts.panes.command);
    if (drawing.shapes?.isOn) notes.push(panelTexts.commandOverlays);
    const give = (colors: string, ...of: string[]) =>
        copy(
            app,
            commandOf(state, size.width, size.height, colors, raw, rawFile.number),
            panelTexts.commandCopied,
            ...of,
            ...notes,
        );
    if (!editing.isEdited && state.least === null) return give(app.table?.name ?? '');
    const file = editing.tomlForCommand();
    if (!file) return;
    if (!savedFiles.has(file.name)) saveFile(file.name, file.text);
    savedFiles.add(file.name);
    give(file.name, panelTexts.commandColors(file.name));
}

export function addShare(app: App, drawing: Drawing, editing: TableEditing, facts: FactsOfShown): void {
    const raw = new RawFile(app, facts);
    const askRaw = () => void (element('settings').hidden || raw.ask().catch(() => undefined));
    element('open').addEventListener('click', askRaw);
    app.on('shown', askRaw);
    // Marks the button as disabled if no command draws the view. A press then shows the reason.
    const mark = () => element('command').setAttribute('aria-disabled', String(whyNoCommand(app, drawing) !== ''));
    app.on(['view', 'shown', 'choices', 'cells'], mark);
    drawing.pictureChanged.push(mark);
    element('actions').append(
        button('share', panelTexts.share, () => copy(app, app.link, panelTexts.shared)),
        button('save', panelTexts.save, () => save(app, drawing)),
        button('command', panelTexts.command, () => copyCommand(app, drawing, editing, raw)),
        button('netcdf', panelTexts.netcdf, () => {
            const { shown } = app;
            if (!shown) return;
            if (isRegion(shown.domain) || shown.isBetween) return app.say(panelTexts.noNetcdf);
            location.href = address(`${gridPath(shown.domain, shown.moment, shown.time)}/netcdf`);
        }),
    );
    mark();
}
