// cli/picture/scene_options.h -- the options for the contents of a picture, which `frame` and
// `loop` share.
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
    std::string theme{render::theme_name(render::Theme::dark)};
    std::string colours;    // empty: those of the product or the moment
    std::string smooth;     // cubic or none; empty: cubic, but none for a scene file
    std::string time_zone;  // IANA; empty: that of the machine
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

// Adds the options of product, colors, camera and labels to a subcommand, and --threads. `options`
// must outlive the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);
// Puts those of `loop` alone on it: the rows of [loop]. Both must outlive the parse.
void add_loop_settings(CLI::App& app, SceneOptions& options, LoopSettings& loop);

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
