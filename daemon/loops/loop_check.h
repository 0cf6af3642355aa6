// daemon/loops/loop_check.h -- checks whether `stormcellar loop` accepts a [[loop]] table and its
// scene.
//
// Asks the program itself, because the daemon reads no scenes and links no renderer. It draws and
// writes nothing, and neither the cache nor the directories of outputs need to exist. Thread
// contract: the main thread (daemon/process/child.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/config/loop_config.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Fails for the first loop that is wrong: bad_argument, "[[loop]] NAME: why"; io if the program
// does not answer within a minute; not_found if there are loops but no program. If `program` is
// empty, it is stormcellar, beside this program or on PATH.
[[nodiscard]] Status check_loops(const std::vector<LoopConfig>& loops,
                                 const std::filesystem::path& cache,
                                 std::filesystem::path program = {});

// What may be intended but gives no picture as things are: the directory of an output does not
// exist, or a domain is neither a known station nor one of `domains`. Each text is "[[loop]] NAME:
// what", printable. Only the loop's own table is checked, not its scene.
[[nodiscard]] std::vector<std::string> doubts_about(const std::vector<LoopConfig>& loops,
                                                    const std::vector<pipeline::Domain>& domains);

}  // namespace stormcellar::daemon
