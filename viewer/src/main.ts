// Creates all parts of the page.

import { App } from './page/app';
import { addCompass } from './page/compass';
import { element } from './page/dom';
import { Drawing } from './page/drawing';
import { FactsOfShown } from './page/facts_of_shown';
import { Fitting } from './page/fitting';
import { Keys } from './page/keys';
import { laterProgram } from './page/later_program';
import { Live } from './page/live';
import { Budget, Loader } from './page/loader';
import { addChoices } from './page/panels/choices';
import { addLegend } from './page/panels/legend';
import { loadLayers } from './page/panels/load_layers';
import { addMode } from './page/panels/mode_choice';
import { addPanels } from './page/panels/open_panels';
import { addTimeline } from './page/panels/time_bar';
import { Pointers } from './page/pointers';
import { addMap } from './page/start/open_map';
import { texts } from './page/texts';
import { Renderer } from './renderer/renderer';
import { stateOf } from './scene/view_state';

function begin(): void {
    // A page that shows the viewer in a frame may hide its controls: /view/?embed=1#...
    document.body.classList.toggle('embedded', new URLSearchParams(location.search).get('embed') === '1');
    const picture = element<HTMLCanvasElement>('picture');
    const renderer = new Renderer(picture);
    const { mostTexels } = renderer;
    const app = new App(new Loader(new Budget(stateOf(location.hash).memoryMib * 2 ** 20, mostTexels), mostTexels));
    const drawing = new Drawing(app, renderer, picture);
    const keys = new Keys(app, drawing);
    new Fitting(app, drawing);
    const facts = new FactsOfShown(app);
    const pointers = new Pointers(app, drawing);
    addChoices(app, drawing, facts);
    addLegend(app);
    addTimeline(app, keys);
    addMap(app, keys);
    addPanels({ app, drawing, facts, keys, pointers });
    loadLayers(app, drawing);
    addCompass(app, drawing);
    addMode(app, drawing);
    // Tell the style sheet the heights of head and foot, so that panels and panes leave room for all their lines.
    for (const id of ['head', 'foot']) {
        const box = element(id);
        const tell = () => document.documentElement.style.setProperty(`--${id}`, `${box.offsetHeight}px`);
        new ResizeObserver(tell).observe(box);
    }
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
    const tell = (what: unknown) => {
        element('state').textContent = texts.failed(what instanceof Error ? what.message : String(what));
    };
    // Without WebGL 2, show pictures that the server draws.
    if (error instanceof Error && error.message === 'webgl2')
        laterProgram<typeof import('./page/panels/later_panels')>('panels').then(
            ({ showStills }) => showStills(),
            tell,
        );
    else tell(error);
}
