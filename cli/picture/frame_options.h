// cli/picture/frame_options.h -- what the command line of `frame` says.
#pragma once

#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_file.h"
#include "cli/picture/scene_options.h"
#include "cli/shared/service_places.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/still.h"

namespace stormcellar::cli {

struct FrameOptions {
    std::vector<std::string> sources;  // files, or a domain
    std::string domain;
    PlaceOption cache;
    PlaceOption catalog{Directory::catalog, {}, {}};  // of a ppi of a domain
    GridOptions grid;                                 // of files
    std::string time;                                 // empty: the latest
    std::string output;                               // empty: nothing is drawn, only probed
    std::string panels;    // moments of a picture with several; empty: one
    std::string probe;     // "X,Y"
    std::string probe_at;  // a place
    std::string geotiff;   // what a GeoTIFF holds
    render::TiffContent tiff = render::TiffContent::values;
    bool json = false;
    SceneFile scene_file;
    SceneOptions scene;
    PicturePlanOptions plan;
};

// Checks that -o, --probe and --probe-at say something to do. Errors: bad_argument.
[[nodiscard]] Status check_frame_options(const FrameOptions& options);
// Takes the panels of a scene file, unless panels or one moment were typed.
void take_panels(FrameOptions& options);
// Checks what -o and --geotiff say together with the product, and takes what a GeoTIFF shall hold.
// Errors: bad_argument, and those of check_still_output().
[[nodiscard]] Status check_frame_output(FrameOptions& options, render::Product product);

}  // namespace stormcellar::cli
