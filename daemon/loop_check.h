// daemon/loop_check.h -- whether `stormcellar loop` takes what a [[loop]] gives it, its scene
// included.
//
// Asks the program itself, since the daemon reads no scenes and links no renderer. Nothing is
// drawn or written, and neither cache nor directories of outputs have to be there.
// Thread contract: the main thread (daemon/child.h).
#pragma once

#include <filesystem>
#include <vector>

#include "base/result.h"
#include "daemon/loop_config.h"

namespace stormcellar::daemon {

// The first loop that is not right: bad_argument, "[[loop]] NAME: why"; io for one of which nothing
// is heard within a minute. not_found where there are loops and no program. `program` empty:
// stormcellar, beside this program or on PATH.
[[nodiscard]] Status check_loops(const std::vector<LoopConfig>& loops,
                                 const std::filesystem::path& cache,
                                 std::filesystem::path program = {});

}  // namespace stormcellar::daemon
