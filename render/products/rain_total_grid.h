// render/products/rain_total_grid.h -- the grid of the product rain-total, from the grids of RATE
// or REF of several volumes.
//
// The grid has the columns of the volumes at their lowest level, and the moment RATE. Its values
// are millimeters: rates that would give the total in one hour. A column that was not seen for more
// than a tenth of the time is ambiguous. A note (retrieve/rain/rain_note.h) says which time the
// total covers, how many minutes of it have no volumes, and how many columns were not seen all the
// time.
//
// Units     mm.
// Threads   One thread at a time; work is split over `threads`.
#pragma once

#include <optional>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/retrieve/rain_total.h"

namespace stormcellar::render {

// Returns the middle of the time that the grid's volume took, or the instant of a mosaic's frame.
[[nodiscard]] UtcTime middle_of(const cache::GridDescription& grid);

class RainTotalGrid {
  public:
    // Without a span, the total goes from the first volume to the last.
    explicit RainTotalGrid(std::optional<retrieve::RainSpan> span = std::nullopt) : span_(span) {}

    // Adds the rates of a later volume: its grid, or the lowest cells alone. Errors: bad_argument
    // for volumes of different radars, unless they are mosaics; those of RainTotal::add().
    [[nodiscard]] Status add(const grid::BrickView& rate, const cache::GridDescription& description,
                             int threads);
    // Ends the total at the end of the span. Call once, after the last volume.
    void close();

    // Returns the total of each column. Errors: bad_argument for fewer than two volumes.
    [[nodiscard]] Result<grid::BrickGrid> bricks() const;
    // Returns the description of the newest volume at the end of the total, with the note.
    [[nodiscard]] cache::GridDescription description() const;

  private:
    std::optional<retrieve::RainSpan> span_;
    std::optional<retrieve::RainTotal> total_;
    UtcTime first_, last_;  // the middles of the first and of the last volume
    int volumes_ = 0;
    cache::GridDescription description_;
};

}  // namespace stormcellar::render
