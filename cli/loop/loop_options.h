// cli/loop/loop_options.h -- what `loop` was asked for.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/loop/archive_options.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_file.h"
#include "cli/picture/scene_options.h"
#include "cli/shared/follow.h"
#include "cli/shared/query_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::cli {

class DrawnFrames;

struct LoopOptions : LoopSettings {
    std::string piped;  // of the outputs the one that goes to standard output
    std::string cache;
    ArchiveOptions archive;
    SceneFile scene_file;
    FollowOptions follow;
    std::string interval;     // from frame to frame; empty: each grid that there is
    std::string time_method;  // empty: advected
    bool json = false;
    bool quiet = false;
    bool only_check = false;  // nothing is drawn
    SceneOptions scene;
    PicturePlanOptions plan;
    DrawnFrames* kept = nullptr;  // of a loop that is followed
};

// Puts the options that are the loop's own on its subcommand, and those of the scene and the plan.
// `options` must outlive the parse.
void add_loop_options(CLI::App& loop, LoopOptions& options);

// When frames stand, and how they are made between grids.
struct Rhythm {
    std::optional<std::chrono::seconds> interval;
    grid::TimeMethod method = grid::TimeMethod::advected;
};
// bad_argument, naming the option.
[[nodiscard]] Result<Rhythm> rhythm_of(const LoopOptions& options);

// bad_argument where the grids' source is not said, or --follow goes with what cannot be followed.
[[nodiscard]] Status check_sources(const LoopOptions& options);

// bad_argument when two outputs are the same file.
[[nodiscard]] Status check_outputs(const std::vector<std::string>& outputs);

}  // namespace stormcellar::cli
