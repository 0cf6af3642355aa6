// cli/scene_options.h -- the options that say what a picture shows; `frame` and `loop` share them.
#pragma once

#include <string>

#include "base/result.h"
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

// What the labels say about a grid.
[[nodiscard]] render::FrameFacts facts_of(const std::string& domain,
                                          const cache::GridDescription& description);

}  // namespace stormcellar::cli
