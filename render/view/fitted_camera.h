// render/view/fitted_camera.h -- chooses camera, exaggeration, opacity and sun from the echo to be
// seen.
//
// The outline says where echo is, in one grid or in all grids of a loop; for a loop the view does
// not move. fit_view() chooses the parts that the caller leaves to it:
//   shown    The columns that reach a threshold: the highest of 40, 30, 20 and 5 dBZ that is
//            reached on 60 km2 or more. If there is no such threshold, all columns with a value.
//            The 2 to 98 % ranges of these columns in both directions, widened by 12 % and 5 km,
//            give the region to show. If the threshold is 40 dBZ, columns in the region that reach
//            35 dBZ are shown too. Moments other than REF show all columns with a value.
//   place    The camera is so near that the ground under these columns and their tops fill 84 % of
//            the width or of the height of the picture. The solution is exact, not iterated.
//   azimuth  The camera looks from the south. A long region is seen from its long side, at most 45
//            degrees from the south.
//   tilt, exaggeration, opacity
//            The size of the region decides: a small region is seen from the side (70 degrees,
//            exaggeration 2), a wide region from above (52 degrees), with low tops stretched up to
//            5 times. Weaker echo is drawn more opaque.
//   sun      65 degrees to the left of the camera, 40 degrees high.
// Without any echo the camera sees the whole grid.
//
// Units     As in stormcellar/render/scene.h.
// Threads   Functions without state.
// Errors    None.
#pragma once

#include "render/view/echo_outline.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// The parts of the view that fit_view() chooses; the scene keeps all others.
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
    Eye focus;              // the middle of the shown echo
    double distance_m = 0;  // from the camera to the focus, in drawn space; 0: no place was fitted
    bool has_echo = false;
};

// Chooses a view for a picture of this size (without its labels). With `orbits`, the shown echo
// stays in the picture when the camera moves around the focus. A camera with parallel rays (a field
// of view of 0 in the scene) has no place to fit.
[[nodiscard]] FittedView fit_view(const EchoOutline& outline, const Scene& scene, int width,
                                  int height, const FitParts& parts = {}, bool orbits = false);
// Returns the camera of a fitted view, turned around its focus. Positive turns go clockwise seen
// from above.
[[nodiscard]] Camera turned(const FittedView& fitted, double by_deg, bool curved_earth = false);
void apply(const FittedView& fitted, Scene& scene);

}  // namespace stormcellar::render
