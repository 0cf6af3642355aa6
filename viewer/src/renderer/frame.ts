// Declares what the renderer draws in one picture, or in one pane of a picture.

import { LoadedGrid } from '../atlas/loaded_grid';
import { ViewGeometry } from '../camera/geometry';
import { ColorTable } from '../wire/color_tables';
import { DrawnLayers } from './layer_passes';

export interface Frame {
    loaded: LoadedGrid;
    geometry: ViewGeometry;
    slices: number;
    grain: number; // the picture is enlarged this many times along each side
    isNearest: boolean; // cells are not interpolated
    opacity: number;
    table: ColorTable;
    leastValue: number; // smaller values are not shown
    hasVolume: boolean;
    hasGround: boolean;
    layers?: DrawnLayers | null;
    keepsExposure?: boolean; // the exposure of the last picture is used again
}
