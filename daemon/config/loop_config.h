// daemon/config/loop_config.h -- the [[loop]] tables of stormcellard.toml: animations that are kept
// fresh.
//
// What a loop shows is said by a scene file of stormcellar (docs/rendering.md), which the daemon
// does not read; the keys here are what a service has to know, and win over the scene file's.
// daemon/stormcellard.toml explains them.
// Thread contract: plain data, pure functions.
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
    std::string domain;                // empty: the scene's
    int last = 0;                      // grids; 0: the scene's
    int seconds = 0;                   // the newest so long; 0: the scene's
    std::vector<std::string> outputs;  // absolute; none: the scene's

    bool operator==(const LoopConfig&) const = default;
};

// What the status says of one.
struct LoopState {
    std::string name;
    bool is_running = false;
    std::uint64_t restarts = 0, made = 0;  // since the daemon was started
    std::optional<UtcTime> last_made;
    int frames = 0;            // of the last one
    std::string last_problem;  // why it ended or did not start; empty: it never did
    bool operator==(const LoopState&) const = default;
};

// Whether a scene's file has to be there. A service runs without: a file that is gone stops its
// loop, which says so, and nothing else.
enum class SceneFiles { as_named, must_exist };

// All [[loop]] tables; what makes no sense is complained of and left out. Relative paths start at
// `directory`; no output may lie within one of `apart`.
[[nodiscard]] std::vector<LoopConfig> read_loops(TomlTable& root,
                                                 const std::filesystem::path& directory,
                                                 const std::vector<std::filesystem::path>& apart,
                                                 SceneFiles scenes = SceneFiles::as_named);

// What `stormcellar` is given to keep it fresh, as a child of the process `parent`.
[[nodiscard]] std::vector<std::string> arguments_of(const LoopConfig& loop,
                                                    const std::filesystem::path& cache,
                                                    long parent);

}  // namespace stormcellar::daemon
