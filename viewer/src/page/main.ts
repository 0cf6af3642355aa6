// Puts the page together.

import { App } from './app';
import { addCompass } from './compass';
import { element } from './dom';
import { Drawing } from './drawing';
import { FactsOfShown } from './facts_of_shown';
import { Keys } from './keys';
import { Live } from './live';
import { stateOf } from '../scene/view_state';
import { Budget, Loader } from './loader';
import { addChoices } from './panels/choices';
import { addEditor } from './panels/edit_colors';
import { Hover } from './panels/hover';
import { LayersPanel } from './panels/layers';
import { addLegend } from './panels/legend';
import { addLook } from './panels/look';
import { Reader } from './panels/reading';
import { addShare } from './panels/share';
import { addTimeline } from './panels/timeline';
import { ToolsPanel } from './panels/tools';
import { addUnits } from './panels/units';
import { Pointers } from './pointers';
import { StartMap } from './start/start_map';
import { TableEditing } from './table_editing';
import { texts } from './texts';

async function begin(): Promise<void> {
    const drawing = new Drawing();
    const { mostTexels } = drawing.renderer;
    const app = new App(new Loader(new Budget(stateOf(location.hash).memoryMib * 2 ** 20, mostTexels), mostTexels));
    drawing.begin(app);
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
    // Panels leave room for the head, however many lines it has.
    const head = element('head');
    new ResizeObserver(() => document.documentElement.style.setProperty('--head', `${head.offsetHeight}px`)).observe(head);
    pointers.begin();
    keys.begin();
    window.addEventListener('hashchange', ({ newURL }) => app.takeAddress(new URL(newURL).hash));
    // The stream is there before the lists, so that nothing is lost between them.
    void new Live(app, app.begin().catch(error => app.fail(error))).hear();
}

begin().catch(error => {
    const isWithout = error instanceof Error && error.message === 'webgl2';
    element('state').textContent = isWithout ? texts.noWebgl : texts.failed(error instanceof Error ? error.message : String(error));
});
