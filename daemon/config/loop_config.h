// daemon/config/loop_config.h -- the [[loop]] tables of stormcellard.toml: animations that are kept
// up to date.
//
// A scene file of stormcellar (docs/rendering.md), which the daemon does not read, says what a loop
// shows. The keys here are those that a service must know; they override the scene file.
// daemon/stormcellard.toml explains them. Thread contract: plain data, pure functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

struct LoopConfig {
    std::string name;                  // [A-Za-z0-9][A-Za-z0-9_-]{0,63}
    std::filesystem::path scene;       // empty: the defaults of `stormcellar loop`
    std::string domain;                // empty: as in the scene
    int last = 0;                      // how many grids; 0: as in the scene
    int seconds = 0;                   // how old grids may be; 0: as in the scene
    std::vector<std::string> outputs;  // absolute; none: as in the scene

    bool operator==(const LoopConfig&) const = default;
};

// The state of one loop, for the status.
struct LoopState {
    std::string name;
    bool is_running = false;
    std::uint64_t restarts = 0, made = 0;  // since the daemon started
    std::optional<UtcTime> last_made;
    int frames = 0;            // in the last loop that was made
    std::string last_problem;  // why the process ended or did not start; empty: neither happened
    bool operator==(const LoopState&) const = default;
};

// Whether the file of a scene must exist. A running service does without: a loop whose scene file
// is gone stops and says so, and nothing else stops.
enum class SceneFiles { as_named, must_exist };

// Reads all [[loop]] tables; complains of invalid ones and leaves them out. Relative paths start at
// `directory`; no output may be within one of `apart`.
[[nodiscard]] std::vector<LoopConfig> read_loops(TomlTable& root,
                                                 const std::filesystem::path& directory,
                                                 const std::vector<std::filesystem::path>& apart,
                                                 SceneFiles scenes = SceneFiles::as_named);

// The arguments with which `stormcellar` keeps the loop up to date, as a child of the process
// `parent`.
[[nodiscard]] std::vector<std::string> arguments_of(const LoopConfig& loop,
                                                    const std::filesystem::path& cache,
                                                    long parent);

}  // namespace stormcellar::daemon
