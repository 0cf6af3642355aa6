// batch/frame_task.h -- makes the frames of an hour, of what grid tasks left in the cache.
//
// What is done is judged by records, never by what an engine says: frames are only made once all of
// their grid tasks have a record. A frame that stands and was made of the present partials stays.
//
// Threads   One task at a time in a process, because a process is measured as a whole.
// Errors    unmet, naming the first grid task that is not done; those of the cache and of making
//           frames; busy after a stop.
#pragma once

#include "batch/grid_task.h"

namespace stormcellar::batch {

// Errors: unmet, naming the first of these tasks that has no record; those of check_stands(), and
// of opening the cache.
[[nodiscard]] Status check_needs(const Plan& plan, std::size_t first, std::size_t end);

[[nodiscard]] Result<TaskOutcome> run_frame_task(const Plan& plan, const Task& task,
                                                 const TaskOptions& options);

}  // namespace stormcellar::batch
