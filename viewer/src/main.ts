// Creates all parts of the page.

import { App } from './page/app';
import { addCompass } from './page/compass';
import { element } from './page/dom';
import { Drawing } from './page/drawing';
import { FactsOfShown } from './page/facts_of_shown';
import { Keys } from './page/keys';
import { Live } from './page/live';
import { Renderer } from './renderer/renderer';
import { stateOf } from './scene/view_state';
import { Budget, Loader } from './page/loader';
import { addChoices } from './page/panels/choices';
import { addEditor } from './page/panels/edit_colors';
import { Hover } from './page/panels/hover';
import { LayersPanel } from './page/panels/layers_panel';
import { addLegend } from './page/panels/legend';
import { addLook } from './page/panels/look';
import { Reader } from './page/panels/reader';
import { addShare } from './page/panels/share';
import { addTimeline } from './page/panels/time_bar';
import { ToolsPanel } from './page/panels/tools';
import { addUnits } from './page/panels/unit_choice';
import { Pointers } from './page/pointers';
import { StartMap } from './page/start/start_map';
import { TableEditing } from './page/table_editing';
import { texts } from './page/texts';

function begin(): void {
    const picture = element<HTMLCanvasElement>('picture');
    const renderer = new Renderer(picture);
    const { mostTexels } = renderer;
    const app = new App(new Loader(new Budget(stateOf(location.hash).memoryMib * 2 ** 20, mostTexels), mostTexels));
    const drawing = new Drawing(app, renderer, picture);
    const keys = new Keys(app, drawing);
    const facts = new FactsOfShown(app);
    const hover = new Hover(app, drawing, facts);
    const reader = new Reader(app, drawing, hover);
    const editing = new TableEditing(app);
    const pointers = new Pointers(app, drawing, reader);
    addChoices(app, facts);
    addLook(app, drawing, keys, editing);
    addLegend(app);
    addTimeline(app, keys);
    addUnits(app);
    addShare(app, drawing, editing, facts);
    reader.begin(keys);
    hover.begin();
    new StartMap(app).begin();
    new ToolsPanel(app, drawing, pointers, facts).begin(keys);
    keys.add('h', () => app.goToMap());
    new LayersPanel(app, drawing, pointers).begin(keys);
    addEditor(app, drawing, editing, keys);
    addCompass(app, drawing);
    keys.add('Escape', () => pointers.use(null));
    // Tell the style sheet the height of the head, so that panels leave room for all its lines.
    const head = element('head');
    new ResizeObserver(() => document.documentElement.style.setProperty('--head', `${head.offsetHeight}px`)).observe(
        head,
    );
    pointers.begin();
    keys.begin();
    window.addEventListener('hashchange', ({ newURL }) => app.takeAddress(new URL(newURL).hash));
    // Open the stream of events before asking for lists, so that no news between them is lost.
    void new Live(
        app,
        app.begin().catch((error: unknown) => app.fail(error)),
    ).hear();
}

try {
    begin();
} catch (error) {
    const isWithout = error instanceof Error && error.message === 'webgl2';
    element('state').textContent = isWithout
        ? texts.noWebgl
        : texts.failed(error instanceof Error ? error.message : String(error));
}
