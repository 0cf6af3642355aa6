// cli/scene_options.h -- the options that say what a picture shows; `frame` and `loop` share them.
#pragma once

#include <string>

#include "base/result.h"
#include "base/utc_time.h"
#include "cache/grid_file.h"
#include "render/render.h"
#include "render/scene.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

struct SceneOptions {
    std::string product = "volume";
    render::Scene scene;  // what the options set; take it by scene_of()
    double range_ring_spacing_km = 50;
    bool no_labels = false;
    int threads = 0;  // 0: as many as the machine has
};

// Puts --product, --width, --height, --azimuth, --tilt, --zoom, --slices, --exaggeration,
// --opacity, --ring-spacing-km, --no-labels and --threads on a subcommand. `options` must outlive
// the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);

// The scene asked for, validated; bad_argument names the option that makes no sense.
[[nodiscard]] Result<render::Scene> scene_of(const SceneOptions& options);

[[nodiscard]] int thread_count(const SceneOptions& options);

// What the labels say about a grid. The local time is that of an IANA zone, of the machine's when
// none is named; left out where it is UTC or not known. How old the newest radial is at `now` is
// said of grids younger than an hour: of an archive's it would say nothing about the radar.
[[nodiscard]] render::FrameFacts facts_of(const std::string& domain,
                                          const cache::GridDescription& description,
                                          const std::string& time_zone = {},
                                          UtcTime now = now_utc());

}  // namespace stormcellar::cli
