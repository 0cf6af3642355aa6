// cli/picture/rain_total_grid.h -- the grid of the product rain-total, from the grids of RATE of
// several volumes.
//
// The grid has the columns of the volumes at their lowest level, and the moment RATE. Its values
// are millimeters, the rate that gives the total in one hour. A column that was not seen for more
// than a tenth of the time is ambiguous. A note says how many columns were not seen all the time.
//
// Units     mm.
// Threads   One thread at a time; work is split over `threads`.
#pragma once

#include <optional>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/retrieve/rain_total.h"

namespace stormcellar::cli {

class RainTotalGrid {
  public:
    // Adds a later volume. Errors: bad_argument if it is of another radar; those of
    // RainTotal::add().
    [[nodiscard]] Status add(const grid::BrickView& view, const cache::GridDescription& description,
                             int threads);

    // These need at least two volumes; errors: bad_argument.
    [[nodiscard]] Result<grid::BrickGrid> bricks() const;
    // Returns the description of the newest volume, with notes on the time and what was not seen.
    [[nodiscard]] cache::GridDescription description() const;

  private:
    std::optional<retrieve::RainTotal> total_;
    UtcTime since_;
    int volumes_ = 0;
    cache::GridDescription description_;
};

}  // namespace stormcellar::cli
