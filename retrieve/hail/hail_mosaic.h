// retrieve/hail/hail_mosaic.h -- merges the hail of several radars by maximum.
//
// A mosaic merges reflectivity by a mean of the radars that see a cell, which weakens hail that one
// radar sees well and another radar poorly. So the columns with hail come whole from the radar
// whose SHI is largest. SHI and MESH of such a mosaic are the largest of its radars, column by
// column, and the mark "at least" comes from the same radar. Columns in which no radar sees hail
// stay as they are merged: a mean is never larger than the largest value, so they have no hail
// either.
//
// Source    MRMS merges hail by maximum (Smith et al. 2016).
// Units     Heights in meters above mean sea level.
// Accuracy  SHI equals that of hail_of_column() for the radar's own column
//           (tests/retrieve/hail_mosaic_test.cpp).
// Not covered  Hail that no single radar sees in full depth, because each sees a part of it.
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::retrieve {

class HailMosaic {
  public:
    // Errors: those of hail_layers().
    [[nodiscard]] static Result<HailMosaic> make(const grid::GridSpec& spec,
                                                 const FreezingLevels& levels);
    // Copies into the mosaic those columns in which this radar has more hail than the radars before
    // it. Both are grids of reflectivity; that of the radar may be a window of the mosaic. Errors:
    // bad_argument if a grid has other cells.
    [[nodiscard]] Status add(const grid::Grid& radar, grid::Grid& mosaic);

  private:
    HailMosaic(grid::GridSpec spec, HailLayers layers);

    // Copies a column that begins at cell `from` of the radar to cell `to`, if it has more hail.
    void add_column(const grid::Grid& radar, std::size_t from, grid::Grid& mosaic, std::size_t to);

    grid::GridSpec spec_;
    HailLayers layers_;
    std::vector<float> largest_shi_;  // of each column
    std::vector<float> dbz_;          // of one column
};

}  // namespace stormcellar::retrieve
