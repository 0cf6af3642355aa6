// web/data/storms/storm_scans.h -- finds the storm cells of grids in the cache and tracks them
// (stormcellar/retrieve/storm_cells.h).
//
// The cells of each grid are kept, so each grid is searched once. A grid that is made again has
// another id and is searched again. The grid of azimuthal shear of the same time is used if it has
// the same cells. MESH is computed for the freezing levels of the configuration.
//
// Units     The budget is in bytes; a scan counts as the sizes of its cells and columns.
// Threads   Many threads may use it. One thread at a time searches a grid.
// Errors    See each function.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/retrieve/storm_cells.h"
#include "web/data/storms/storm_areas.h"

namespace stormcellar::web {

class StormScans {
  public:
    explicit StormScans(std::shared_ptr<Grids> grids, retrieve::FreezingLevels freezing = {},
                        std::uint64_t budget_bytes = std::uint64_t{32} << 20)
        : grids_(std::move(grids)), freezing_(freezing), kept_({.weight = budget_bytes}) {}

    using Scan = std::shared_ptr<const retrieve::CellScan>;
    // Returns the cells of a grid of reflectivity, with the motion of the echo since the grid
    // `before`, if that is given and has the same cells. Errors: those of Grids::find(),
    // find_cells() and GridFile::check_whole().
    [[nodiscard]] Result<Scan> scan(const std::string& area, UtcTime time,
                                    std::optional<UtcTime> before = {});
    // Returns the cells of the area's newest grid, tracked through its grids. Leaves out grids that
    // were evicted since the times were listed. Errors: those of scan() and track_cells().
    [[nodiscard]] Result<retrieve::TrackedScan> track(const StormArea& area);

    [[nodiscard]] const std::shared_ptr<Grids>& grids() const { return grids_; }
    [[nodiscard]] const retrieve::FreezingLevels& freezing() const { return freezing_; }
    // Returns the number of grids that were searched.
    [[nodiscard]] std::uint64_t searched() const;

  private:
    const std::shared_ptr<Grids> grids_;
    const retrieve::FreezingLevels freezing_;
    mutable Mutex mutex_;
    RecentlyUsed<std::string, Scan> kept_ STORMCELLAR_GUARDED_BY(mutex_);
    std::uint64_t searched_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
};

}  // namespace stormcellar::web
