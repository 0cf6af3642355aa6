// notify/area_watch.h -- finds the cells of an area, a station or a domain, whenever a grid comes.
//
// The watch reads the REF grids of the last three hours, so that it knows the tracks of cells right
// after a start. The id of a cell stays the same as long as the cell's first grid is one of these
// grids. A grid that will be replaced (of a volume that has not ended, or a provisional frame)
// counts only when there is a later grid. A file that cannot be read is left out.
//
// Threads   One thread at a time.
// Errors    Those of listing the cache. Problems of single grids are logged. An area without grids
// is logged once, because its name may be wrong.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "service/log.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::notify {

class AreaWatch {
  public:
    AreaWatch(std::filesystem::path cache, std::string area, retrieve::FreezingLevels freezing)
        : cache_(std::move(cache)), area_(std::move(area)), freezing_(freezing) {}

    // Reads new grids, but only a few in each call, so that a call takes some seconds at most.
    // Returns the cells of the newest grid if all grids were read and this grid is new, young
    // (`oldest_news`) and not reported before.
    [[nodiscard]] Result<std::optional<retrieve::TrackedScan>> look(UtcTime now);
    // Makes the next look() return the newest grid again.
    void report_again() { reported_.reset(); }

    [[nodiscard]] const std::string& area() const { return area_; }
    // A message about cells of an older grid would come too late.
    static constexpr std::chrono::minutes oldest_news{20};

  private:
    bool read_new(const std::vector<cache::StoreEntry>& entries);
    Result<bool> read(const cache::StoreEntry& entry, const cache::StoreEntry* before,
                      bool is_last);
    Result<std::optional<retrieve::TrackedScan>> newest(UtcTime now);

    const std::filesystem::path cache_;
    const std::string area_;
    const retrieve::FreezingLevels freezing_;
    std::vector<retrieve::CellScan> scans_;  // in any order, one for each time
    std::set<UtcTime> damaged_;              // grids that cannot be read
    std::optional<UtcTime> reported_;
    FirstFailure has_grids_;
};

}  // namespace stormcellar::notify
