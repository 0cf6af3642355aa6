// daemon/loops/others_loops.h -- the loops that another process keeps
// (daemon/loops/loops_service.h), for the metrics.
//
// Threads   May be called from any thread.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "daemon/config/loop_config.h"

namespace stormcellar::daemon {

// Returns the loops of a document that loops_json() wrote; none if it cannot be understood. If the
// `state` of the document is not "running", no loop runs.
[[nodiscard]] std::vector<LoopState> loops_of(std::string_view document);

// Returns each configured loop with the state that STATE/loops/status.json gives. A loop that is
// missing there does not run. No loop runs if the file does not exist or the process that wrote it
// is gone.
[[nodiscard]] std::vector<LoopState> others_loops(const std::filesystem::path& state,
                                                  const std::vector<LoopConfig>& configured);

}  // namespace stormcellar::daemon
