// web/data/pictures/flat_map.h -- a 2D product of a grid, or a sweep, which is made once, with
// coarser levels for small scales.
//
// Level 0 has a cell for each column of the grid. For a sweep, it has a cell for each column of the
// sweep's plane, which is as wide as a gate is long. Each further level has half as many columns
// and rows, until neither is more than 32. A cell of a further level is made from the four cells
// that it covers (fewer at an edge of odd length):
//   state   a value if any of the four has a value; else range folded if any of them is; else no
//           echo if any of them was seen; else not seen. So small scales hide no echo.
//   value   VEL: the value farthest from 0. ZDR, RHO, CFP: the mean. PHI, whose values are on a
//           circle: the value of the first cell with one, from the southwest. Other moments, and
//           products whose unit is not their moment's: the largest value.
//
// Units     Those of render/products/flat_field.h. A cell takes 5 bytes. All levels together take
//           4/3 of the first.
// Threads   A FlatMap is constant. Many threads may use FlatMaps. If several want the same map at
//           the same time, one makes it and the others wait.
// Errors    See each function.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/recently_used.h"
#include "render/products/flat_field.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/scene.h"
#include "web/data/grids/grids.h"
#include "web/data/pictures/sweep_pictures.h"

namespace stormcellar::web {

struct FlatMap {
    grid::GridSpec spec;
    std::shared_ptr<const PlacedSweep> sweep;  // whose gates level 0 samples; null: of a grid
    std::vector<render::FlatField> levels;     // at least one
    // FlatField::at_least of level 0. It is empty in `levels`, so that pictures of all scales look
    // alike.
    std::vector<std::uint8_t> at_least;
    [[nodiscard]] std::uint64_t bytes() const;
};

// Returns the field with half the columns and rows.
[[nodiscard]] render::FlatField halved_field(const render::FlatField& field,
                                             const render::Scene& scene, int threads = 1);

class FlatMaps {
  public:
    // The newest map is kept however large it is, because neighboring tiles need it, too.
    // `cache` is the directory of the cache whose grids are shown.
    explicit FlatMaps(std::uint64_t budget_bytes, std::filesystem::path cache = {})
        : cache_(std::move(cache)), maps_({.weight = budget_bytes}) {}

    // Returns the map of the scene's product. Errors: those of shown_grid() and still_field(), and
    // of a grid that was truncated while it was read.
    [[nodiscard]] Result<std::shared_ptr<const FlatMap>> find_or_make(const OpenGrid& grid,
                                                                      const render::Scene& scene,
                                                                      int threads);
    // Returns the map of the sweep. Errors: those of SweepPictures::decode().
    [[nodiscard]] Result<std::shared_ptr<const FlatMap>> find_or_make(const SweepPicture& picture,
                                                                      const SweepPictures& sweeps,
                                                                      int threads);

  private:
    using Make = std::function<Result<std::shared_ptr<const FlatMap>>()>;
    [[nodiscard]] Result<std::shared_ptr<const FlatMap>> find_or_make(const std::string& key,
                                                                      const Make& make);

    const std::filesystem::path cache_;
    mutable Mutex mutex_;
    ConditionVariable made_;
    RecentlyUsed<std::string, std::shared_ptr<const FlatMap>> maps_ STORMCELLAR_GUARDED_BY(mutex_);
    std::set<std::string> making_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
