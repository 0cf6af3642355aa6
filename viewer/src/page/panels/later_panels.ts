// Adds the parts of the page that no picture needs: settings, tools, readings, and the panel of layers. open_panels.ts
// loads them.

import { App } from '../app';
import { element } from '../dom';
import { Drawing } from '../drawing';
import { FactsOfShown } from '../facts_of_shown';
import { Keys } from '../keys';
import { panelTexts } from '../later_texts';
import { isHidden } from '../picked';
import { Pointers } from '../pointers';
import { TableEditing } from '../table_editing';
import { addEditor } from './edit_colors';
import { Hover } from './hover';
import { LayersPanel } from './layers_panel';
import { addLook } from './look';
import { addLoopEnds } from './loop_ends';
import { OverlayRows } from './overlay_rows';
import { Reader } from './reader';
import { addScale } from './scale_mark';
import { PaneHeads } from './pane_heads';
import { addPaneChoice } from './pane_choice';
import { ScanPanel } from './scan_panel';
import { addShare } from './share';
import { StationLine } from './station_line';
import { addTilts } from './tilts';
import { TimeTracks } from './time_tracks';
import { ToolsPanel } from './tools';
import { addUnits } from './unit_choice';

export { showStills } from './still_page';

export interface PageParts {
    app: App;
    drawing: Drawing;
    facts: FactsOfShown;
    keys: Keys;
    pointers: Pointers;
}

export function begin({ app, drawing, facts, keys, pointers }: PageParts): void {
    const heads = new PaneHeads(app, drawing);
    const hover = new Hover(app, drawing, facts, heads);
    const reader = new Reader(app, drawing, hover);
    const editing = new TableEditing(app);
    drawing.hideNames(isHidden);
    addLook(app, drawing, keys, editing);
    addUnits(app);
    addShare(app, drawing, editing, facts);
    reader.begin(keys);
    hover.begin();
    new ToolsPanel(app, drawing, pointers, facts).begin(keys);
    new LayersPanel(app, drawing, pointers).begin(keys);
    new OverlayRows(app, drawing).begin();
    new ScanPanel(app, drawing).begin(keys);
    addLoopEnds(app);
    new StationLine(app, drawing, facts).begin();
    addScale(app, drawing);
    addTilts(app, drawing, keys);
    new TimeTracks(app, drawing).begin();
    addPaneChoice(app, drawing, keys);
    heads.begin();
    addEditor(app, drawing, editing, keys);
    keys.add('Escape', () => pointers.use(null));
    for (const [id, tip] of Object.entries(panelTexts.tips)) element(id).title = tip;
    pointers.setUsual(reader);
}
