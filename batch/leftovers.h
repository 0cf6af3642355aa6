// batch/leftovers.h -- removes temporary files of writers that were killed.
//
// Many writers share a cache, so no one may remove a file that another is writing. The name of a
// temporary file contains the host and process that write it (stormcellar/base/file_system.h).
//
// Threads   Functions without state.
// Errors    None. Files that cannot be removed stay.
#pragma once

#include <cstddef>
#include <filesystem>

#include "batch/plan.h"

namespace stormcellar::batch {

// Removes temporary files from the directories of the task's grids if the process that wrote them
// ran on this host and has ended.
void remove_own_leftovers(const Recipe& recipe, const Task& task);

// Removes all temporary files in the cache, and beside the records and counts. Call it when no task
// runs any more. Returns the number of removed files.
std::size_t remove_all_leftovers(const Plan& plan);

}  // namespace stormcellar::batch
