// cli/loop/loop_options.h -- the options of `loop`.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/loop/archive_options.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_arguments.h"
#include "cli/picture/scene_file.h"
#include "cli/shared/follow.h"
#include "cli/shared/query_options.h"
#include "cli/shared/service_places.h"
#include "render/options/fitted_view.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::cli {

class DrawnFrames;

struct LoopOptions : LoopSettings {
    std::string piped;                 // the output that is standard output, as typed
    std::vector<std::string> sources;  // files, or a domain, as typed
    std::string typed_domain;          // from --domain; `domain` may be from a scene file
    std::vector<std::string> files;    // the sources, if they are files
    PlaceOption cache_place;           // as typed; `cache` is the result
    std::string cache;
    ArchiveOptions archive;
    std::set<std::filesystem::path> archive_files;  // with files: the files of the catalog to use
    SceneFile scene_file;
    FollowOptions follow;
    std::string interval;     // time between frames; empty: one frame for each grid
    std::string time_method;  // empty: advected
    std::string panels;       // as typed; a loop refuses them
    bool json = false;
    bool quiet = false;
    bool only_check = false;  // nothing is drawn
    SceneOptions scene;
    PicturePlanOptions plan;
    // Pictures to reuse, in a followed loop.
    DrawnFrames* kept = nullptr;
    std::optional<render::FittedView>* kept_view = nullptr;  // view to reuse, in a followed loop
};

// Adds the options of the loop, its scene and its plan to the subcommand. `options` must outlive
// the parse.
void add_loop_options(CLI::App& loop, LoopOptions& options);

// The times of the frames, and how to make frames at times between grids.
struct Rhythm {
    std::optional<std::chrono::seconds> interval;
    grid::TimeMethod method = grid::TimeMethod::advected;
};
// Parses the options for the times of frames. Errors: bad_argument, naming the option.
[[nodiscard]] Result<Rhythm> rhythm_of(const LoopOptions& options);

// Sorts the words of the command line into files and a domain, and finds the cache that has the
// domain. Errors: those of tell_apart() and PlaceOption::find(), and of the cache.
[[nodiscard]] Status take_sources(LoopOptions& options);

// Checks the sources. Errors: bad_argument if no source of grids is given, or if --follow is
// combined with a source that cannot be followed.
[[nodiscard]] Status check_sources(const LoopOptions& options);

// Checks the outputs. Errors: bad_argument if two outputs are the same file.
[[nodiscard]] Status check_outputs(const std::vector<std::string>& outputs);

}  // namespace stormcellar::cli
