// grid/plan/position_error.h -- how far each effect of geometry moves what a grid samples: bounds
// for a volume over a grid, in metres.
//
//   ellipsoid        the sphere's bound of stormcellar/grid/frame_ladder.h within the reach
//   exact_geodesic   1 mm, the table's
//   earth_curvature  the greatest distance between a gate's places by both beams, over the sweeps'
//   refraction       elevations, arcs within the reach and heights of the grid (beam_model.h)
//   antenna_jitter   the farthest a radial was measured off its sweep, times the range at which
//                    it leaves the grid
// Others move nothing: 0. Threads: pure.
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

// Refers to what it is made of.
struct PositionScene {
    const level2::Volume& volume;
    const SitePosition& site;
    const GridSpec& spec;
    const std::vector<ChosenSweep>& chosen;
    const RefractivityProfile& profile;
    level2::Moment moment = level2::Moment::ref;
};

// The lesser of the farthest column's and the farthest gate's arc.
[[nodiscard]] double reach_m(const PositionScene& scene);

[[nodiscard]] double effect_position_m(const PositionScene& scene, std::string_view effect);

// The sum over what a method and a frame leave off.
[[nodiscard]] double position_error_bound_m(const PositionScene& scene, FrameKind frame,
                                            const Method& method);

// For provenance of a grid that was made without a plan: "position 714 m, values not predicted,
// against the chain's exact form".
[[nodiscard]] std::string unplanned_error(const level2::Volume& volume, const SitePosition& site,
                                          const GridSpec& spec, FrameKind frame,
                                          const GridderOptions& options);

}  // namespace stormcellar::grid
