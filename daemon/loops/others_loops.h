// daemon/loops/others_loops.h -- loops that another process keeps (daemon/loops/loops_service.h),
// for the metrics.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "daemon/config/loop_config.h"

namespace stormcellar::daemon {

// The loops of loops_json()'s document; of one that cannot be understood, none. No loop runs where
// its `state` is not "running".
[[nodiscard]] std::vector<LoopState> loops_of(std::string_view document);

// Each configured loop as STATE/loops/status.json has it; one that is not in it does not run, nor
// does any where the file is not there or the process that wrote it is gone.
[[nodiscard]] std::vector<LoopState> others_loops(const std::filesystem::path& state,
                                                  const std::vector<LoopConfig>& configured);

}  // namespace stormcellar::daemon
