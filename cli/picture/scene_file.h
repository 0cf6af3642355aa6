// cli/picture/scene_file.h -- `--scene FILE.toml`: all that a picture or a loop is, in a file.
//
// The sections [picture], [camera], [light], [volume], [labels], [plan] and [loop], each key named
// after its option (docs/rendering.md has them all). Whatever is not in the file stays as it is.
// Relative paths (colour tables, outputs) start at the directory of the file.
// Errors: not_found, io ... of the file; bad_argument, "FILE:LINE: [section] key: why", for what is
// in it, unknown keys included. What only makes sense together (a section and its line) is checked
// by scene_of(), when the options of the command line have been added; scene_with() then names the
// file.
// Thread contract: pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_options.h"
#include "cli/shared/query_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::cli {

// What [loop] says, and what the options of `loop` say.
struct LoopSettings {
    std::string domain;
    TimeRangeOptions range;
    int last = 0;          // of the grids only so many; 0: all
    double orbit_deg = 0;  // the camera's way round the grid over the loop
    bool ping_pong = false;
    std::vector<std::string> outputs;
    render::AnimationOptions animation;
};

// Sets what the file names, and nothing when there is an error in it.
[[nodiscard]] Status read_scene_file(const std::filesystem::path& file, SceneOptions& scene,
                                     PicturePlanOptions& plan, LoopSettings& loop);

// The option --scene. `error` is what was wrong with the file, for the command to report; `alone`
// is what makes no sense of it as long as no option is given beside it, which one may yet mend.
struct SceneFile {
    std::string path;
    std::optional<Error> error;
    std::optional<Error> alone;
};

// As scene_of(). Where a file was given, the message is "FILE: why" for what the file alone has
// wrong, and "why (beside --scene FILE)" for what the options may have brought in.
[[nodiscard]] Result<render::Scene> scene_with(const SceneFile& file, const SceneOptions& options);

// Puts --scene on a subcommand: the first option that is put on it, so that those that are given
// beside it are taken after the file and win. `loop` may be null: [loop] is then checked and left
// alone. The others must outlive the parse.
void add_scene_file(CLI::App& app, SceneFile& file, SceneOptions& scene, PicturePlanOptions& plan,
                    LoopSettings* loop);

}  // namespace stormcellar::cli
