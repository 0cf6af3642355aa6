// cli/picture/scene_options.h -- the options that say what a picture shows; `frame` and `loop`
// share them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/picture/picture_options.h"
#include "stormcellar/base/number_range.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/render.h"
#include "stormcellar/render/scene.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

inline constexpr NumberRange thread_range{0, 1024};

// What the options of a picture set, and the scene files (picture_options.h).
struct SceneOptions {
    std::string product = "volume";
    std::string moment{level2::moment_name(level2::Moment::ref)};
    std::string colours;    // empty: the product's or the moment's
    std::string time_zone;  // IANA; empty: the machine's
    bool no_labels = false;
    int threads = 0;      // 0: as many as the machine has
    render::Scene scene;  // what the options set directly; take it by scene_of()
    // The options that were typed, those that a scene file has, and the product that the file is
    // for, which is empty where no file was given.
    ChosenOptions typed;
    ChosenOptions in_file;
    std::string file_product;
    std::optional<Error> problem;  // the first value that was typed and makes no sense
};

// Puts the options of the scene on a subcommand. `options` must outlive the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);
// Puts those of `loop` alone on it: the rows of [loop]. Both must outlive the parse.
void add_loop_settings(CLI::App& app, SceneOptions& options, LoopSettings& loop);

// The scene asked for, validated; bad_argument names the option that makes no sense. An option that
// the product does not use is an error and not dropped, since who gives it expects to see it. Only
// what a scene file says for its own product is left out beside a product that was typed.
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
