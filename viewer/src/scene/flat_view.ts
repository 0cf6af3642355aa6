// Switches a view between 2D, a map of one tilt, and 3D.

import { namedView } from '../camera/controls';
import { flatLayers, usualLayers } from './layers';
import { ViewState, usualState } from './view_state';

// The parts of a view that 2D and 3D have separately.
export type Stance = Pick<ViewState, 'camera' | 'layers'>;

// Returns the camera and layers for a first look in 2D or 3D. The look is at the same place as in the other one.
function firstStance({ camera, layers }: Stance, isFlat: boolean): Stance {
    if (isFlat) return { camera: namedView(camera, 'top'), layers: flatLayers(layers) };
    const { zoom, lookAtM } = camera;
    return { camera: { ...usualState.camera, zoom, lookAtM }, layers: { ...usualLayers, hasCells: layers.hasCells } };
}

// Returns the view in 2D or 3D. `kept` is the last stance there, which comes back; null before the first look.
export function switched(state: ViewState, isFlat: boolean, kept: Stance | null): ViewState {
    return { ...state, isFlat, ...(kept ?? firstStance(state, isFlat)) };
}

// Returns the stance for another domain, whose places differ.
export const elsewhere = ({ camera, layers }: Stance): Stance => ({
    camera: { ...camera, lookAtM: null, zoom: 1 },
    layers: { ...layers, sweepNumber: null, section: null, crop: null },
});
