// cli/picture/scene_file.h -- `--scene FILE.toml`: everything that defines a picture or a loop, in
// a file.
//
// It has the sections [picture], [camera], [light], [volume], [labels], [plan] and [loop]; each key
// is named after its option (docs/rendering.md lists them all). What is not in the file is left
// unchanged. Relative paths (color tables, outputs) start at the directory of the file. What only
// makes sense in combination (a section and its line) is checked by scene_of(), after the options
// of the command line were added; scene_with() then names the file.
//
// Threads   Pure: may be called from any thread.
// Errors    not_found, io and others of the file; bad_argument, "FILE:LINE: [section] key: why",
//           for its contents, unknown keys included.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_options.h"
#include "cli/shared/query_options.h"
#include "render/view/camera_path.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::cli {

// The settings of a loop, from [loop] and from the options of `loop`.
struct LoopSettings : LoopChoices {
    std::string domain;
    TimeRangeOptions range;
    std::vector<render::CameraKey> camera;  // places on its way; empty: it has none
    std::vector<std::string> outputs;
};

// Sets what the file names; sets nothing if there is an error in it.
[[nodiscard]] Status read_scene_file(const std::filesystem::path& file, SceneOptions& scene,
                                     PicturePlanOptions& plan, LoopSettings& loop);

// The option --scene. `error` is what was wrong with the file, for the command to report. `alone`
// is what is invalid as long as no option is given in addition, which may correct it.
struct SceneFile {
    std::string path;
    std::optional<Error> error;
    std::optional<Error> alone;
};

// Like scene_of(). If a file was given, the message is "FILE: why" for an error of the file alone,
// and "why (beside --scene FILE)" for one that the options may have caused.
[[nodiscard]] Result<render::Scene> scene_with(const SceneFile& file, const SceneOptions& options);

// Adds --scene to a subcommand. It must be the first option added, so that the options given in
// addition are taken after the file and override it. `loop` may be null: [loop] is then checked and
// ignored. The others must outlive the parse.
void add_scene_file(CLI::App& app, SceneFile& file, SceneOptions& scene, PicturePlanOptions& plan,
                    LoopSettings* loop);

}  // namespace stormcellar::cli
