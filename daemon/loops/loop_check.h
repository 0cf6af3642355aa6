// daemon/loops/loop_check.h -- checks that `stormcellar loop` accepts a [[loop]] and its scene.
//
// The check runs `stormcellar loop --check`, because the daemon reads no scenes and links no
// renderer. With this option the program draws and writes nothing; neither the cache nor the
// directories of outputs need to exist.
//
// Threads   Main thread only (service/child.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/config/loop_config.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Checks the loops in order, and returns the error of the first loop that fails. If `program` is
// empty, runs the stormcellar beside this program or on PATH. Errors: bad_argument, "[[loop]] NAME:
// why"; io if the program does not start or end within a minute; not_found if there are loops but
// no program.
[[nodiscard]] Status check_loops(const std::vector<LoopConfig>& loops,
                                 const std::filesystem::path& cache,
                                 std::filesystem::path program = {});

// Returns warnings for loops that are allowed but cannot be written or drawn now. A loop gets a
// warning if the directory of an output is missing, or if the loop's domain is neither a known
// station nor one of `domains`. Looks only at the loop's own table, not at its scene. A warning is
// printable: "[[loop]] NAME: what".
[[nodiscard]] std::vector<std::string> doubts_about(const std::vector<LoopConfig>& loops,
                                                    const std::vector<pipeline::Domain>& domains);

}  // namespace stormcellar::daemon
