// Switches a view between 2D, a map of one tilt, and 3D.

import { namedView } from '../camera/controls';
import { Camera } from '../camera/geometry';
import { Layers, flatLayers, usualLayers } from './layers';
import { allPanes, withLayers, withPanes } from './panes';
import { ViewState, usualState } from './view_state';

// The parts of a view of which 2D and 3D have their own: the camera, and the layers of each pane.
export type Stance = Pick<ViewState, 'camera' | 'moment' | 'layers' | 'least' | 'colors' | 'panes' | 'active'>;

// Return camera and layers for a first look in 2D or 3D. The look is at the same place as before the switch.
function firstCamera(camera: Camera, isFlat: boolean): Camera {
    const { zoom, lookAtM } = camera;
    return isFlat ? namedView(camera, 'top') : { ...usualState.camera, zoom, lookAtM };
}
const firstLayers = (layers: Layers, isFlat: boolean): Layers =>
    isFlat ? flatLayers(layers) : { ...usualLayers, hasCells: layers.hasCells };

// Returns the view in 2D or 3D. `kept` is the last stance there, which comes back; null before the first look.
export function switched(state: ViewState, isFlat: boolean, kept: Stance | null): ViewState {
    const keptPanes = kept ? allPanes(kept) : [];
    const isKept = keptPanes.length === allPanes(state).length;
    const all = withLayers(state, (layers, i) => (isKept ? keptPanes[i]!.layers : firstLayers(layers, isFlat)));
    const camera = kept?.camera ?? firstCamera(state.camera, isFlat);
    return { ...state, isFlat, camera, ...withPanes(all, state.active) };
}

// Returns the stance for another domain, whose places differ.
export const elsewhere = (stance: Stance): Stance => ({
    camera: { ...stance.camera, lookAtM: null, zoom: 1 },
    ...withPanes(
        withLayers(stance, (layers) => ({ ...layers, sweepNumber: null, section: null, crop: null })),
        stance.active,
    ),
});
