// daemon/loops/loop_check.h -- whether `stormcellar loop` takes what a [[loop]] gives it, its scene
// included.
//
// Asks the program itself, since the daemon reads no scenes and links no renderer. Nothing is
// drawn or written, and neither cache nor directories of outputs have to be there.
// Thread contract: the main thread (daemon/process/child.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/config/loop_config.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// The first loop that is not right: bad_argument, "[[loop]] NAME: why"; io for one of which nothing
// is heard within a minute. not_found where there are loops and no program. `program` empty:
// stormcellar, beside this program or on PATH.
[[nodiscard]] Status check_loops(const std::vector<LoopConfig>& loops,
                                 const std::filesystem::path& cache,
                                 std::filesystem::path program = {});

// What may be meant, but has no picture as things are: an output's directory that is not there, a
// domain that is neither a known station nor one of `domains`. "[[loop]] NAME: what", printable. Of
// what the loop's own table says; what its scene says is not looked at.
[[nodiscard]] std::vector<std::string> doubts_about(const std::vector<LoopConfig>& loops,
                                                    const std::vector<pipeline::Domain>& domains);

}  // namespace stormcellar::daemon
