// Grids as the renderer takes them: whole, or in parts.

import { PackedGrid } from '../wire/packed_grid';
import { Atlas } from './atlas';
import { MadeColumn } from './brick_store';
import { Pyramid } from './pyramid';

// Grid with what the graphics processor needs to draw it.
export interface LoadedGrid {
    grid: PackedGrid;
    atlas: Atlas;
    coverage: Uint8Array; // of a grid in parts: of its first halved grid
    stream: GridInParts | null;
}

// Grid of which only the table and a halved grid are there; the rest is fetched as the view needs it. Its
// atlas is empty at first.
export interface GridInParts {
    key: string;
    domain: string;
    moment: string;
    time: string;
    pyramid: Pyramid;
    shownOf: Uint8Array; // shown code of each code
    level: number; // how often the first halved grid was halved
    first: MadeColumn[]; // all columns of it that have values
    isClear: boolean; // it shows clear air, if it is of reflectivity
}
