// daemon/config/loop_config.h -- the [[loop]] tables of stormcellard.toml. Each describes an
// animation that the service keeps up to date.
//
// A scene file of stormcellar (docs/rendering.md) defines the pictures of a loop; the daemon does
// not read it. The keys of [[loop]] override the same keys of the scene file.
// daemon/stormcellard.toml explains all keys.
//
// Threads   Plain data and pure functions: may be called from any thread.
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
    std::string domain;                // empty: the domain of the scene
    int last = 0;                      // number of newest grids to show; 0: as in the scene
    int seconds = 0;                   // show only grids of the last seconds; 0: as in the scene
    std::vector<std::string> outputs;  // absolute paths; empty: as in the scene

    bool operator==(const LoopConfig&) const = default;
};

struct LoopState {
    std::string name;
    bool is_running = false;
    std::uint64_t restarts = 0, made = 0;  // since the daemon started
    std::optional<UtcTime> last_made;
    int frames = 0;            // in the last animation
    std::string last_problem;  // why the loop last ended or did not start; empty: no problem yet
    bool operator==(const LoopState&) const = default;
};

// Says whether the scene files of loops must exist. A running service accepts a missing file: it
// stops only the loop of that scene, and reports the problem.
enum class SceneFiles { as_named, must_exist };

// Reads all [[loop]] tables. Reports invalid tables and leaves them out. Relative paths start at
// `directory`. No output may be within one of the directories `apart`.
[[nodiscard]] std::vector<LoopConfig> read_loops(TomlTable& root,
                                                 const std::filesystem::path& directory,
                                                 const std::vector<std::filesystem::path>& apart,
                                                 SceneFiles scenes = SceneFiles::as_named);

// Returns the arguments with which `stormcellar` keeps the loop up to date. The program runs as a
// child of the process `parent`.
[[nodiscard]] std::vector<std::string> arguments_of(const LoopConfig& loop,
                                                    const std::filesystem::path& cache,
                                                    long parent);

}  // namespace stormcellar::daemon
