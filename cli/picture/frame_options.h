// cli/picture/frame_options.h -- the command line of `frame`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_arguments.h"
#include "cli/picture/scene_file.h"
#include "cli/shared/service_places.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/still.h"

namespace stormcellar::cli {

struct FrameOptions {
    std::vector<std::string> sources;  // files, or a domain
    std::string domain;
    PlaceOption cache;
    PlaceOption catalog{Directory::catalog, {}, {}};  // finds the raw volume of a ppi of a domain
    GridOptions grid;                                 // for a grid made from files
    std::string time;                                 // empty: the latest
    std::optional<double> hours = {};                 // length of a rain total
    std::string output;                               // empty: no picture, only a probe
    std::string panels;    // moments of a picture with several panels; empty: one panel
    std::string probe;     // "X,Y"
    std::string probe_at;  // the name or coordinates of a place
    std::string geotiff;   // content of a GeoTIFF
    render::TiffContent tiff = render::TiffContent::values;
    bool rotation = false;  // draw columns of rotation
    bool json = false;
    SceneFile scene_file;
    SceneOptions scene;
    PicturePlanOptions plan;
};

// Checks that one of -o, --probe and --probe-at is given. Errors: bad_argument.
[[nodiscard]] Status check_frame_options(const FrameOptions& options);
// Uses the panels of a scene file, unless panels or one moment were typed.
void take_panels(FrameOptions& options);
// Checks -o and --geotiff against the product, and reads the content of a GeoTIFF. Errors:
// bad_argument, and those of check_still_output().
[[nodiscard]] Status check_frame_output(FrameOptions& options, render::Product product);

}  // namespace stormcellar::cli
