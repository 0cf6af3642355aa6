// pipeline/mosaic/frame_parts.h -- what a frame was made of, and what of it has changed since.
//
// A frame in the cache names the partials that it was made of, each by a fingerprint of everything
// that counts for the frame: its cells (by the checksums of its bricks), columns, site and times.
// It also names its recipe: the rules of overlap and time. So when a new volume comes, it is known
// on which columns the new frame differs, and the other columns are copied (grid::update()). A
// fingerprint covers what a grid file says of its bricks: verify the codes before copying them.
// Inside the pipeline room only. Thread contract: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {

// XXH3; never 0.
[[nodiscard]] std::uint64_t fingerprint_of(const PartialView& partial);
[[nodiscard]] std::uint64_t recipe_of(const FrameOptions& options);

// The position of each partial's window, and its fingerprint.
// Errors: bad_argument for a partial that is not a window of the domain.
[[nodiscard]] Result<std::vector<grid::FramePart>> parts_of(
    const grid::GridSpec& domain, std::span<const PartialView* const> partials);

// The windows of all sites whose partials were added, removed or replaced between two frames. Both
// lists are sorted by ICAO, then time.
[[nodiscard]] std::vector<grid::GridWindow> changed_windows(std::span<const grid::FramePart> before,
                                                            std::span<const grid::FramePart> now);

// Returns true if two windows share a column of bricks.
[[nodiscard]] bool share_bricks(const grid::GridWindow& a, const grid::GridWindow& b);

}  // namespace stormcellar::pipeline
