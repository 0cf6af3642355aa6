// cli/picture/scene_file.h -- `--scene FILE.toml`: reads everything that defines a picture or a
// loop from a file.
//
// The file has the sections [picture], [camera], [light], [volume], [labels], [plan] and [loop].
// Each key is named after its option (docs/rendering.md lists them all). A key that is absent
// changes nothing. Relative paths (color tables, outputs) start at the directory of the file. Some
// settings only make sense together, such as a section and its line. scene_of() checks these after
// the options of the command line were added; scene_with() then adds the name of the file to the
// error.
//
// Threads   Pure: may be called from any thread.
// Errors    not_found, io and others of the file; bad_argument, "FILE:LINE: [section] key: why",
//           for its contents, including unknown keys.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture/picture_plan.h"
#include "cli/picture/scene_arguments.h"
#include "cli/shared/query_options.h"
#include "render/view/camera_path.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::cli {

// The settings of a loop, from [loop] and from the options of `loop`.
struct LoopSettings : LoopChoices {
    std::string domain;
    TimeRangeOptions range;
    std::vector<render::CameraKey> camera;  // keys of the loop's camera path; empty: no path
    std::vector<std::string> outputs;
};

// Reads the settings of the file. Sets nothing if the file has an error.
[[nodiscard]] Status read_scene_file(const std::filesystem::path& file, SceneOptions& scene,
                                     PicturePlanOptions& plan, LoopSettings& loop);

// The option --scene. `error` is an error of the file, which the command must report. `alone` is an
// error that a typed option may correct.
struct SceneFile {
    std::string path;
    std::optional<Error> error;
    std::optional<Error> alone;
};

// Returns the scene that scene_of() makes. If a file was given, an error's message is "FILE: why"
// if the file alone causes the error, or "why (beside --scene FILE)" if options may have caused it.
[[nodiscard]] Result<render::Scene> scene_with(const SceneFile& file, const SceneOptions& options);

// Adds --scene to a subcommand. --scene must be the first option added, so that the other options
// are applied after the file and override it. If `loop` is null, [loop] is checked and ignored. The
// other arguments must outlive the parse.
void add_scene_file(CLI::App& app, SceneFile& file, SceneOptions& scene, PicturePlanOptions& plan,
                    LoopSettings* loop);

}  // namespace stormcellar::cli
