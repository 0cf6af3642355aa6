// pipeline/mosaic/frame_parts.h -- records what a frame was made from, and finds what has changed
// since. Used only inside the pipeline room.
//
// A frame in the cache lists the partials from which it was made. Each has a fingerprint of
// everything in it that affects the frame: its cells (by the checksums of its bricks), columns,
// site and times. The frame also has its recipe, a hash of the rules for overlap and time. So when
// a new volume comes, only the columns in which the new frame differs must be merged; the other
// columns are copied (grid::update()). A fingerprint covers only the checksums of bricks and not
// their codes, so verify the codes before copying.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {

// Returns the fingerprint of a partial, an XXH3 hash that is never 0.
[[nodiscard]] std::uint64_t fingerprint_of(const PartialView& partial);
[[nodiscard]] std::uint64_t recipe_of(const FrameOptions& options);

// Returns the window and the fingerprint of each partial. Errors: bad_argument for a partial that
// is not a window of the domain.
[[nodiscard]] Result<std::vector<grid::FramePart>> parts_of(
    const grid::GridSpec& domain, std::span<const PartialView* const> partials);

// Returns the windows of all sites whose partials differ between two frames. Both lists must be
// sorted by ICAO, then time.
[[nodiscard]] std::vector<grid::GridWindow> changed_windows(std::span<const grid::FramePart> before,
                                                            std::span<const grid::FramePart> now);

// Returns true if two windows share a column of bricks.
[[nodiscard]] bool share_bricks(const grid::GridWindow& a, const grid::GridWindow& b);

}  // namespace stormcellar::pipeline
