// pipeline/mosaic/mosaic_effects.h -- defines the steps of making a frame of several sites, the
// ways to do each step (rungs), and the effects that better rungs include. First come the steps of
// gridding (grid/plan/grid_effects.h), which are the same for all volumes, and then the steps of
// merging:
//
//   step      rungs, from cheap to exact                     effects that reach them
//   time      nearest, blend, advected                       time_blend, echo_motion
//   sweeps    all at one time, each at its own time             sweep_times
//   overlap   the nearest site, the requested rule              site_overlap
//   codes     default steps, fine steps                      fine_codes
// The user chooses the rule by which sites overlap. If this rule is the nearest site, the step has
// no effect. The exact rung of `time` uses the motion that the default grids show.
//
// Threads   Pure functions.
#pragma once

#include "grid/mosaic/time_interpolation.h"
#include "grid/plan/grid_effects.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::pipeline {

// The names of the steps of merging. grid::step has the names of the steps of gridding.
namespace step {
inline constexpr std::string_view time = "time";
inline constexpr std::string_view sweeps = "sweeps";
inline constexpr std::string_view overlap = "overlap";
inline constexpr std::string_view codes = "codes";
}  // namespace step
[[nodiscard]] bool is_of_merging(const accuracy::Step& step);

// A choice of one rung for every step.
struct MosaicChoice {
    grid::SceneChoice gridding;
    grid::TimeMethod time = grid::TimeMethod::advected;
    bool sweep_times = true;
    bool mixes_sites = true;
    bool fine_codes = false;
    bool operator==(const MosaicChoice&) const = default;
};

// Returns the chain with the names, rungs and sentences of its steps. The steps of gridding come
// first.
[[nodiscard]] accuracy::Chain mosaic_effects_of(level2::Moment moment, grid::Averaging averaging,
                                                grid::Overlap overlap);

[[nodiscard]] MosaicChoice mosaic_choice(const accuracy::Chain& chain,
                                         const accuracy::Choice& choice);

// Returns the choice that applies without a budget: the default of gridding, advected, each sweep
// at its own time, the requested rule of overlap, and default codes. Settings of the chain's
// effects override this choice.
[[nodiscard]] accuracy::Choice default_mosaic_choice(const accuracy::Chain& chain,
                                                     const grid::GridSpec& domain,
                                                     double beam_width_deg);

// Returns the default quantization of the moment. If `fine`, returns codes of two bytes, whose step
// is a 64th of the default step, or a 16th if the default also has two bytes.
[[nodiscard]] grid::Quantization quantization_of(level2::Moment moment, bool fine);

// Returns the options, changed to the rungs of the choice.
[[nodiscard]] PartialOptions with_choice(PartialOptions options, const MosaicChoice& choice);
[[nodiscard]] FrameOptions with_choice(FrameOptions options, const MosaicChoice& choice);

}  // namespace stormcellar::pipeline
