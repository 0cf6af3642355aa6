// daemon/loops/others_loops.h -- the state of loops that another process runs
// (daemon/loops/loops_service.h), for the metrics.
//
// Threads   May be called from any thread.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "daemon/config/loop_config.h"

namespace stormcellar::daemon {

// Returns the loops of a document that loops_json() wrote; none if the document is invalid. Loops
// count as running only if the `state` of the document is "running" and the process named in the
// document exists.
[[nodiscard]] std::vector<LoopState> loops_of(std::string_view document);

// Returns each configured loop with its state from STATE/loops/status.json. A loop that the file
// does not have counts as not running. If the file does not exist, or if the process that wrote it
// is gone, no loop counts as running.
[[nodiscard]] std::vector<LoopState> others_loops(const std::filesystem::path& state,
                                                  const std::vector<LoopConfig>& configured);

}  // namespace stormcellar::daemon
