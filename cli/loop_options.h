// cli/loop_options.h -- what `loop` was asked for.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "cli/archive_options.h"
#include "cli/picture_plan.h"
#include "cli/query_options.h"
#include "cli/scene_options.h"
#include "render/animation/animation.h"

namespace stormcellar::cli {

struct LoopOptions {
    std::string cache;
    std::string domain;
    TimeRangeOptions range;
    ArchiveOptions archive;
    std::string interval;     // from frame to frame; empty: each grid that there is
    std::string time_method;  // empty: advected
    std::size_t last = 0;     // 0: all
    double orbit_deg = 0;     // the camera's way round the grid over the loop
    bool ping_pong = false;
    std::vector<std::string> outputs;
    bool json = false;
    bool quiet = false;
    render::AnimationOptions animation;
    SceneOptions scene;
    PicturePlanOptions plan;
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

// bad_argument when two outputs are the same file.
[[nodiscard]] Status check_outputs(const std::vector<std::string>& outputs);

}  // namespace stormcellar::cli
