// batch/leftovers.h -- temporary files of writers that were killed.
//
// Many writers share a cache, so nobody may remove what another one is writing. A temporary file
// says by its name which process of which host writes it (stormcellar/base/file_system.h).
//
// Threads   Pure functions, but for the files.
// Errors    None: what cannot be removed stays.
#pragma once

#include <cstddef>
#include <filesystem>

#include "batch/plan.h"

namespace stormcellar::batch {

// Removes the temporary files, in the directories of the task's grids, of processes of this host
// that have ended.
void remove_own_leftovers(const Recipe& recipe, const Task& task);

// Removes all temporary files in the cache and beside the records. Call it when nothing runs any
// more. Returns their number.
std::size_t remove_all_leftovers(const Plan& plan);

}  // namespace stormcellar::batch
