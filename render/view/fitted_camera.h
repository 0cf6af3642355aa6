// render/view/fitted_camera.h -- chooses camera, exaggeration, opacity and sun to suit the echo
// that is shown.
//
// The outline says where the echo of a grid is. For a loop it covers the echo of all grids, because
// the view does not move. fit_view() chooses the parts that the caller leaves to it:
//   shown    The columns that reach a threshold: the highest of 40, 30, 20 and 5 dBZ that at least
//            60 km2 reach. If there is no such threshold, all columns with a value. Along both
//            axes, the range of 2 to 98 % of these columns, widened by 12 % and 5 km, is the region
//            to show. If the threshold is 40 dBZ, columns of the region that reach 35 dBZ are
//            shown, too. For moments other than REF, all columns with a value are shown.
//   place    As near as possible: the ground under these columns and their tops fill 84 % of the
//            width or of the height of the picture. The place is solved exactly, without iteration.
//   azimuth  The camera looks from the south. It sees a long region from its long side, but turns
//            at most 45 degrees from the south.
//   tilt, exaggeration, opacity
//            These depend on the size of the region. A small region is seen from the side (70
//            degrees, exaggeration 2), a wide region from above (52 degrees), with low tops
//            stretched up to 5 times. Weaker echo is drawn more opaque.
//   sun      65 degrees to the left of the camera, 40 degrees high.
// If there is no echo at all, the camera sees the whole grid.
//
// Units     As in stormcellar/render/scene.h.
// Threads   Functions without state.
// Errors    None.
#pragma once

#include "render/view/echo_outline.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// The parts of the view that fit_view() chooses. All other parts stay as in the scene.
struct FitParts {
    bool azimuth = true, tilt = true, field_of_view = true, place = true;
    bool exaggeration = true, opacity = true, sun = true;

    [[nodiscard]] bool any() const {
        return azimuth || tilt || field_of_view || place || exaggeration || opacity || sun;
    }
    [[nodiscard]] static FitParts none() {
        return {false, false, false, false, false, false, false};
    }
};

// The fitted view, with the point that a moving camera turns around.
struct FittedView {
    Camera camera;
    double vertical_exaggeration = 5;
    double opacity = 1;
    double sun_azimuth_deg = 225, sun_elevation_deg = 40;
    Eye focus;  // the middle of the shown echo
    // From the camera to the focus, in drawn space; 0 if no place was fitted.
    double distance_m = 0;
    bool has_echo = false;
};

// Chooses a view for a picture of this size (without its labels). With `orbits`, the shown echo
// stays in the picture while the camera moves around the focus. For a camera with parallel rays
// (the scene has a field of view of 0), no place is fitted.
[[nodiscard]] FittedView fit_view(const EchoOutline& outline, const Scene& scene, int width,
                                  int height, const FitParts& parts = {}, bool orbits = false);
// Returns the camera of a fitted view after a turn around its focus. Positive turns are clockwise
// as seen from above.
[[nodiscard]] Camera turned(const FittedView& fitted, double by_deg, bool curved_earth = false);
void apply(const FittedView& fitted, Scene& scene);

}  // namespace stormcellar::render
