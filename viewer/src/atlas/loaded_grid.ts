// Declares grids as the renderer takes them: whole grids, and grids in parts.

import { PackedGrid } from '../wire/packed_grid';
import { Atlas } from './atlas';
import { MadeColumn } from './brick_store';
import { Pyramid } from './pyramid';

// A grid, and what the renderer needs to draw it.
export interface LoadedGrid {
    grid: PackedGrid;
    atlas: Atlas;
    coverage: Uint8Array; // if the grid is in parts, the coverage of its first halved grid
    stream: GridInParts | null; // null: the grid is whole
}

// A grid too large to be loaded as a whole. At first only its table and one halved grid are here; the view fetches
// the bricks that it needs. The atlas is empty at first.
export interface GridInParts {
    key: string;
    domain: string;
    moment: string;
    time: string;
    pyramid: Pyramid;
    shownOf: Uint8Array; // shown code of each code
    level: number; // number of halvings of the first halved grid
    first: MadeColumn[]; // all columns with values of the first halved grid
    isClear: boolean; // result of isClearAir(), which counts for reflectivity only
}
