// The parts of layers that few pictures need. load_layers.ts loads them when a layer needs them.

import { rotationOf } from '../rotation';
import { App } from '../app';
import { Drawing } from '../drawing';
import { CellMarks } from './cell_marks';
import { addGlyphs } from './glyph_overlay';
import { SectionPlot } from './section_plot';

export function begin(app: App, drawing: Drawing): void {
    new SectionPlot(app, drawing).put();
    addGlyphs(app, drawing);
    new CellMarks(app, drawing).begin();
    drawing.share.makeRotation = rotationOf;
}
