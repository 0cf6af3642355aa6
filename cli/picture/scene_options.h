// cli/picture/scene_options.h -- the options that say what a picture shows; `frame` and `loop`
// share them.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/render/render.h"
#include "stormcellar/render/scene.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

struct SceneOptions {
    std::string product = "volume";
    std::string moment{level2::moment_name(level2::Moment::ref)};
    std::string colours;   // empty: the product's or the moment's
    double height_km = 3;  // of a CAPPI
    std::string section;   // "LAT,LON,LAT,LON"
    std::string light = "none";
    std::string sun;        // "AZIMUTH,ELEVATION"
    std::string camera_at;  // "EAST,NORTH,UP" in km
    std::string time_zone;  // IANA; empty: the machine's
    render::Scene scene;    // what the options set; take it by scene_of()
    double range_ring_spacing_km = 50;
    bool no_labels = false;
    int threads = 0;  // 0: as many as the machine has
    // Of those that not every product uses (cli/picture/product_options.h): the options that were
    // typed, and what a scene's file says, with the product that the file is for.
    std::vector<std::string> typed;
    std::vector<std::string> in_file;
    std::string file_product;  // empty: no file was given
};

// Puts the options of product, colours, camera and labels on a subcommand, and --threads. `options`
// must outlive the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);

// The scene asked for, validated; bad_argument names the option that makes no sense.
[[nodiscard]] Result<render::Scene> scene_of(const SceneOptions& options);

// So many numbers with commas between them, as in "35.3,-97.3"; bad_argument names the option.
[[nodiscard]] Result<std::vector<double>> numbers_of(const std::string& option,
                                                     const std::string& text, std::size_t count);

[[nodiscard]] int thread_count(const SceneOptions& options);

// What the labels say about a grid. The local time is that of an IANA zone, of the machine's when
// none is named; left out where it is UTC or not known. How old the newest radial is at `now` is
// said of grids younger than an hour: of an archive's it would say nothing about the radar.
[[nodiscard]] render::FrameFacts facts_of(const std::string& domain,
                                          const cache::GridDescription& description,
                                          const std::string& time_zone, UtcTime now = now_utc());

}  // namespace stormcellar::cli
