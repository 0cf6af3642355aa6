// Turns the view that the server fits to the echo of a grid (docs/web/grids.md, `view`) into a camera of the page.
//
// The server's camera has a place near the echo. The page's camera stays outside the grid's box and zooms, so its
// perspective is weaker. Both look in the same direction, have the same point in the middle of the picture, and show
// the echo equally large.

import { Box, Camera, Vec3, ViewGeometry, dot, minus, plus } from '../camera/geometry';
import { FittedView } from '../wire/api';

export function cameraOfFitted(fitted: FittedView, box: Box, width: number, height: number): Camera {
    const { azimuth_deg, tilt_deg, field_of_view_deg, place_m } = fitted.camera;
    const outside: Camera = {
        azimuthDeg: ((azimuth_deg % 360) + 360) % 360,
        tiltDeg: tilt_deg,
        zoom: 1,
        fieldOfViewDeg: field_of_view_deg,
        lookAtM: null,
    };
    if (!place_m) return outside;
    const drawn = ([x, y, z]: Vec3): Vec3 => [x, y, z * fitted.exaggeration];
    const view = new ViewGeometry(box, outside, fitted.exaggeration, width, height);
    const place = drawn(place_m);
    const distanceM = dot(minus(drawn(fitted.focus_m), place), view.forward);
    const [x, y, z] = plus(place, distanceM, view.forward);
    return {
        ...outside,
        zoom: dot(minus(view.middle, view.eye), view.forward) / distanceM,
        lookAtM: [x, y, z / fitted.exaggeration],
    };
}
