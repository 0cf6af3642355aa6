// batch/statistics_task.h -- counts the values in one month's frames of one hour of the day.
//
// PLAN/statistics/201305-20.tally has the counts of the frames from 20:00 to 21:00 in May 2013
// (grid/cells/grid_tally.h). Its first line is JSON: the month, the hour, the number of frames, the
// number of instants that could have a frame, and the checksum and size of the rest of the file.
// The rest is the counts, compressed by zlib. Add up files to get the climatology of some hours,
// some months or the whole time.
//
// Threads   One task at a time in a process.
// Errors    unmet, naming the first frame task that is not done; corrupt for damaged counts; those
//           of the cache.
#pragma once

#include <filesystem>
#include <string>

#include "batch/grid_task.h"
#include "grid/cells/grid_tally.h"

namespace stormcellar::batch {

[[nodiscard]] std::filesystem::path tally_path(const Plan& plan, const MonthHour& part);

[[nodiscard]] Result<TaskOutcome> run_statistics_task(const Plan& plan, const Task& task,
                                                      const TaskOptions& options);

// Contents of a file of counts.
struct MonthTally {
    grid::GridTally tally;
    std::uint64_t instants = 0;  // instants that could have a frame
};
[[nodiscard]] Result<MonthTally> read_tally(const Plan& plan, const MonthHour& part);

}  // namespace stormcellar::batch
