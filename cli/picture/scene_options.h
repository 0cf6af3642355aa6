// cli/picture/scene_options.h -- the options for the contents of a picture, which `frame` and
// `loop` share.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/render.h"
#include "stormcellar/render/scene.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

struct SceneOptions {
    std::string product = "volume";
    std::string moment = "REF";
    std::string colours;   // empty: those of the product or the moment
    double height_km = 3;  // of a CAPPI
    std::string section;   // "LAT,LON,LAT,LON"
    std::string light = "none";
    std::string sun;        // "AZIMUTH,ELEVATION"
    std::string camera_at;  // "EAST,NORTH,UP" in km
    std::string time_zone;  // IANA; empty: that of the machine
    render::Scene scene;    // set by the options; use scene_of() to get it
    double range_ring_spacing_km = 50;
    bool no_labels = false;
    int threads = 0;  // 0: as many as the machine has
    // For those that not every product uses (cli/picture/product_options.h): the options that were
    // typed, and what a scene's file has, with the product of the file.
    std::vector<std::string> typed;
    std::vector<std::string> in_file;
    std::string file_product;  // empty: no file was given
};

// Adds the options of product, colors, camera and labels to a subcommand, and --threads. `options`
// must outlive the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);

// Returns the requested scene, validated. Errors: bad_argument, naming the invalid option.
[[nodiscard]] Result<render::Scene> scene_of(const SceneOptions& options);

// Parses this many numbers separated by commas, as in "35.3,-97.3". Errors: bad_argument, naming
// the option.
[[nodiscard]] Result<std::vector<double>> numbers_of(const std::string& option,
                                                     const std::string& text, std::size_t count);

[[nodiscard]] int thread_count(const SceneOptions& options);

// Returns what the labels say about a grid. The local time is that of an IANA zone, or of the
// machine if none is named; it is left out if it is UTC or not known. The age of the newest radial
// at `now` is given for grids younger than an hour; for those of an archive it would say nothing
// about the radar.
[[nodiscard]] render::FrameFacts facts_of(const std::string& domain,
                                          const cache::GridDescription& description,
                                          const std::string& time_zone, UtcTime now = now_utc());

}  // namespace stormcellar::cli
