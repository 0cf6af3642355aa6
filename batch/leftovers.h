// batch/leftovers.h -- removes temporary files of writers that were killed.
//
// Many writers share a cache, so nobody may remove a file that another process is writing. The name
// of a temporary file contains the host and the process that writes the file
// (stormcellar/base/file_system.h).
//
// Threads   Functions without state.
// Errors    None. Files that cannot be removed stay.
#pragma once

#include <cstddef>
#include <filesystem>

#include "batch/plan.h"

namespace stormcellar::batch {

// Removes the temporary files of ended processes of this host from the directories of the task's
// grids.
void remove_own_leftovers(const Recipe& recipe, const Task& task);

// Removes all temporary files in the cache and beside the records and counts. Call it only while no
// task runs. Returns the number of removed files.
std::size_t remove_all_leftovers(const Plan& plan);

}  // namespace stormcellar::batch
