// cli/picture/stored_cells.h -- the storm cells of a domain of the cache at the times of pictures.
//
// Cells are followed through the grids of reflectivity of the last hour, at most 24. The cells of
// each grid are kept for later pictures, so the frames of a loop find the cells of each grid once.
//
// Threads   One thread at a time.
// Errors    See at().
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/overlays.h"

namespace stormcellar::cli {

class StoredCells {
  public:
    static constexpr std::chrono::minutes history{60};
    static constexpr std::size_t most_grids = 24;
    // A picture shows no cells older than this.
    static constexpr std::chrono::minutes longest_age{30};

    // `freezing` is none if MESH is not wanted.
    StoredCells(cache::StoreReader store, std::string domain,
                std::optional<retrieve::FreezingLevels> freezing)
        : store_(std::move(store)), domain_(std::move(domain)), freezing_(freezing) {}

    // Returns the cells of the newest grid at or before the time. Errors: not_found if there is no
    // such grid, or only one older than longest_age; those of opening grids and of scan_grid().
    [[nodiscard]] Result<render::CellOverlay> at(UtcTime time);

  private:
    [[nodiscard]] Status find(const std::vector<cache::StoreEntry>& entries);

    cache::StoreReader store_;
    std::string domain_;
    std::optional<retrieve::FreezingLevels> freezing_;
    std::map<UtcTime, retrieve::CellScan> scans_;
};

}  // namespace stormcellar::cli
