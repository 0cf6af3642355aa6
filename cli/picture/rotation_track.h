// cli/picture/rotation_track.h -- the largest azimuthal shear of each cell over time.
//
// In each cell, the volume with the higher rank of state counts (retrieve::knowledge()). Of two
// values the larger counts, so that counterclockwise rotation leaves a track.
// retrieve::add_to_track() does the same for the gates of one radar.
//
// Threads   One thread at a time; work is split over `threads`.
#pragma once

#include <optional>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::cli {

class RotationTrack {
  public:
    // Adds a later volume. Errors: bad_argument if its grid differs in place, size or radar.
    [[nodiscard]] Status add(const grid::BrickView& view, const cache::GridDescription& description,
                             int threads);

    // Both functions need at least one volume. The description is that of the newest volume, with a
    // note that gives the time of the first volume (render::track_note()).
    [[nodiscard]] grid::BrickView view() const { return bricks_->view(); }
    [[nodiscard]] const cache::GridDescription& description() const { return description_; }
    [[nodiscard]] grid::BrickGrid take_bricks() { return std::move(*bricks_); }

  private:
    grid::Grid largest_;
    UtcTime since_;
    cache::GridDescription description_;
    std::optional<grid::BrickGrid> bricks_;
};

}  // namespace stormcellar::cli
