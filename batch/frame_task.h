// batch/frame_task.h -- makes the mosaics of an hour from the grids of the grid tasks.
//
// The engine may start tasks in any order, so a frame task makes frames only if all of its grid
// tasks have a record. The task keeps an existing frame if the frame was made from the partials
// that the cache has now. (A partial is one site's grid on the cells of the mosaic.)
//
// Threads   One task at a time in a process, because Usage measures the whole process.
// Errors    unmet, naming the first grid task that is not done; those of the cache and of making
//           frames; busy after a stop.
#pragma once

#include "batch/grid_task.h"

namespace stormcellar::batch {

// Checks that the tasks [first, end) are done and that the cache has their grids. Errors: unmet,
// naming the first task without a record; errors of check_stands() and of opening the cache.
[[nodiscard]] Status check_needs(const Plan& plan, std::size_t first, std::size_t end);

[[nodiscard]] Result<TaskOutcome> run_frame_task(const Plan& plan, const Task& task,
                                                 const TaskOptions& options);

}  // namespace stormcellar::batch
