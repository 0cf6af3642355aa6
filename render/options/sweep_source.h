// render/options/sweep_source.h -- finds the sweep of a volume that a scene asks for, chooses the
// plane on which it is drawn, and describes it.
//
// `stormcellar frame` and the data server both choose by these functions, so that the same options
// give the same picture.
//
// Threads   Functions without state.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/place/source_volume.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Returns the elevation or the number that the scene asks for. If several sweeps have this angle,
// the wish means the sweep that is nearest in time to `nearest_to`, or the newest sweep if no time
// is given.
[[nodiscard]] grid::SweepWish sweep_wish_of(const Scene& scene,
                                            std::optional<UtcTime> nearest_to = {});

// Returns the cuts of the volume's pattern that are nearest in angle to the wish, or the lowest
// cuts if the wish has no angle. No other cut need be decoded. Returns none, which means all cuts,
// in three cases: the wish has a number, which counts all sweeps; the volume has no pattern; or no
// cut is near, so that the error can list all angles.
[[nodiscard]] std::vector<int> cuts_of_wish(const level2::Volume& volume,
                                            const grid::SweepWish& wish);

// Returns a plane about the site that reaches to the last gate. Its cells are as wide as gates.
// Only formats of maps show the cells.
[[nodiscard]] grid::GridSpec plane_of_sweep(const grid::SweepLookup& sweep);

// Describes the sweep on its plane as a grid would be described, for labels and metadata. `file` is
// the path or the name of the volume's file.
[[nodiscard]] cache::GridDescription describe_sweep(const grid::SweepLookup& sweep,
                                                    grid::GridSpec plane,
                                                    const grid::SourceVolume& source,
                                                    const std::string& file);

}  // namespace stormcellar::render
