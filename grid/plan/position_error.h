// grid/plan/position_error.h -- bounds how far each geometric effect moves the samples of a grid:
//
//   ellipsoid        the bound for the sphere in stormcellar/grid/frame_ladder.h, within the reach
//   exact_geodesic   1 mm, the bound of the table
//   earth_curvature, refraction   the greatest distance between the places of a gate by the two
//                                 beams, over the elevations of the sweeps, arcs within the reach
//                                 and heights of the grid (stormcellar/grid/beam_model.h)
//   antenna_jitter   the largest offset of a radial from its sweep's elevation, times the range at
//                    which the radial leaves the grid
// The other effects move nothing, so their bound is 0.
//
// Units     Meters.
// Threads   Pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/grid/frame_ladder.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/refractivity.h"
#include "stormcellar/grid/sweep_choice.h"

namespace stormcellar::grid {

// The input of the bounds. The referenced objects must outlive the PositionScene.
struct PositionScene {
    const level2::Volume& volume;
    const SitePosition& site;
    const GridSpec& spec;
    const std::vector<ChosenSweep>& chosen;
    const RefractivityProfile& profile;
    level2::Moment moment = level2::Moment::ref;
};

// Returns the arc of the farthest column, or of the farthest gate if that is less.
[[nodiscard]] double reach_m(const PositionScene& scene);

[[nodiscard]] double effect_position_m(const PositionScene& scene, std::string_view effect);

// Returns the sum of the bounds of all effects that this method and this frame leave off.
[[nodiscard]] double position_error_bound_m(const PositionScene& scene, FrameKind frame,
                                            const Method& method);

// Returns the error of a grid that is made without a plan, as text for the provenance: "position
// 714 m, values not predicted, against the chain's exact form".
[[nodiscard]] std::string unplanned_error(const level2::Volume& volume, const SitePosition& site,
                                          const GridSpec& spec, FrameKind frame,
                                          const GridderOptions& options);

}  // namespace stormcellar::grid
