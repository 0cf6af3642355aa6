// daemon/loops/others_loops.h -- loops that another process runs (daemon/loops/loops_service.h),
// for the metrics. Thread contract: functions without state.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "daemon/config/loop_config.h"

namespace stormcellar::daemon {

// The loops in a document of loops_json(); none if the document cannot be understood. No loop runs
// if its `state` is not "running".
[[nodiscard]] std::vector<LoopState> loops_of(std::string_view document);

// The state of each configured loop from STATE/loops/status.json. A loop that is not in the file
// does not run; no loop runs if the file is missing or the process that wrote it is gone.
[[nodiscard]] std::vector<LoopState> others_loops(const std::filesystem::path& state,
                                                  const std::vector<LoopConfig>& configured);

}  // namespace stormcellar::daemon
