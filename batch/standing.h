// batch/standing.h -- finds the grids of a task in the cache, whichever run or plan made them.
//
// Threads   Functions without state.
// Errors    Those of listing the cache and of reading its files. A grid does not count if its
//           header is damaged, if its shape is not the shape in the recipe, or if another version
//           of this software made it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "batch/plan.h"
#include "batch/record.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::batch {

struct StandingGrid {
    std::string volume;        // level2::volume_name(); empty for frames and counts
    std::int64_t made_ns = 0;  // modification time of its file, since 1970
    UtcTime time;
    std::uint64_t checksum = 0;
    std::uint64_t bytes = 0;  // on disk
    std::filesystem::path path;
};

// Returns the existing grids of the task, by moment and then time. For a task of statistics,
// returns its file of counts if that file can be read.
[[nodiscard]] Result<std::vector<StandingGrid>> grids_standing(const cache::StoreReader& store,
                                                               const Plan& plan, const Task& task);

// Returns ok if the cache has the grids that the task's record counts. Damaged grids count as
// present. Additional grids are accepted, because another plan may have made them. Errors: also io
// if the cache has fewer grids than the record says, or as many grids with another digest; the
// cache may not be mounted.
[[nodiscard]] Status check_stands(const cache::StoreReader& store, const Plan& plan,
                                  const Task& task, const Record& record);

// Returns true if the grid's bytes fit its checksum. Returns true for every file of counts, without
// reading the file.
[[nodiscard]] Result<bool> is_sound(const StandingGrid& grid);
// If the task has damaged grids, removes the record of the task and then these grids.
[[nodiscard]] Status remove_damaged(const cache::StoreReader& store, const Plan& plan,
                                    const Task& task);

// Returns a digest of all bytes of these grids, in their order.
[[nodiscard]] std::string digest_of(const std::vector<StandingGrid>& grids);

}  // namespace stormcellar::batch
