// daemon/loops/loop_check.h -- checks whether `stormcellar loop` accepts a [[loop]] and its scene.
//
// It runs the program itself, since the daemon reads no scenes and links no renderer. Nothing is
// drawn or written, and neither the cache nor the directories of outputs need to exist.
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

// Checks the loops one after the other and returns the error of the first that is not accepted. An
// empty `program` is the stormcellar beside this program or on PATH. Errors: bad_argument,
// "[[loop]] NAME: why"; io if a check gives no answer within a minute; not_found if there are loops
// but no program.
[[nodiscard]] Status check_loops(const std::vector<LoopConfig>& loops,
                                 const std::filesystem::path& cache,
                                 std::filesystem::path program = {});

// Returns warnings about loops that are allowed but give no picture at present: the directory of an
// output is missing, or a domain is neither a known station nor one of `domains`. Each is "[[loop]]
// NAME: what", printable. Only the loop's own table is checked, not its scene.
[[nodiscard]] std::vector<std::string> doubts_about(const std::vector<LoopConfig>& loops,
                                                    const std::vector<pipeline::Domain>& domains);

}  // namespace stormcellar::daemon
