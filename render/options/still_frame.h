// render/options/still_frame.h -- makes a still of one grid: fits options that are not given to the
// echo, draws the picture, and encodes it with its metadata.
//
// `stormcellar frame` and the data server both draw by these functions, so that the same options
// give the same bytes.
//
// Threads   Pure, except that they change the scene that is fitted. Drawing uses `threads` threads
//           of its own.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "render/options/scene_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/render/still.h"

namespace stormcellar::render {

// The grid and the options from which a still is drawn. The referenced objects must outlive the
// source.
struct StillSource {
    const std::string& domain;
    const grid::BrickView& view;
    const cache::GridDescription& description;
    const SceneOptions& options;
    // If true, the picture tells the age of the newest radial if that is less than an hour. If
    // false, the picture does not depend on the time at which it is drawn.
    bool tells_age = true;
    Overlays overlays = {};  // as for render_frame()
};

// Returns the facts for the labels of the still.
[[nodiscard]] FrameFacts facts_of_still(const StillSource& source);

// Chooses by the echo the options that were not given (fitted_view.h). For a sweep, which is seen
// from above, only sets the angle (scene_shown()). Errors: those of fit_picture().
[[nodiscard]] Status fit_to_grid(const StillSource& source, Scene& scene);

// The settings for writing a still.
struct StillWriting {
    const StillFormat& format;
    TiffContent tiff = TiffContent::values;
    std::string error;  // error of the picture by its plan; empty: not planned
    int threads = 1;
    std::function<void()> drawn;  // called after the picture is drawn, before it is encoded
};

// Draws the fitted scene and encodes the picture. A format of maps encodes the map of the grid
// instead, and does not call `drawn`. Errors: those of render_frame() and of the format.
[[nodiscard]] Result<std::vector<std::byte>> encode_still(const StillSource& source,
                                                          const Scene& scene,
                                                          const StillWriting& writing);

}  // namespace stormcellar::render
