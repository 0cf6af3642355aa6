// pipeline/mosaic/mosaic_effects.h -- the steps, rungs and effects of a frame of several sites:
// those of gridding (grid/plan/grid_effects.h), for all volumes alike, and then
//
//   step      rungs, from cheap to exact                     effects that reach them
//   time      nearest, blend, advected                       time_blend, echo_motion
//   sweeps    as one, each at its own time                   sweep_times
//   overlap   the nearest site, the rule asked for           site_overlap
//   codes     default steps, fine steps                      fine_codes
// The rule by which sites overlap is a definition, like the averaging; if it is the nearest site,
// the step has no effect. The exact form uses the motion that the default grids show.
// Threads: pure functions.
#pragma once

#include "grid/mosaic/time_interpolation.h"
#include "grid/plan/grid_effects.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::pipeline {

// The steps of merging by name, beside those of gridding (grid::step).
namespace step {
inline constexpr std::string_view time = "time";
inline constexpr std::string_view sweeps = "sweeps";
inline constexpr std::string_view overlap = "overlap";
inline constexpr std::string_view codes = "codes";
}  // namespace step
[[nodiscard]] bool is_of_merging(const accuracy::Step& step);

// One rung of every step.
struct MosaicChoice {
    grid::SceneChoice gridding;
    grid::TimeMethod time = grid::TimeMethod::advected;
    bool sweep_times = true;
    bool mixes_sites = true;
    bool fine_codes = false;
    bool operator==(const MosaicChoice&) const = default;
};

// Names, rungs and sentences; the steps of gridding come first, in their order.
[[nodiscard]] accuracy::Chain mosaic_effects_of(level2::Moment moment, grid::Averaging averaging,
                                                grid::Overlap overlap);

[[nodiscard]] MosaicChoice mosaic_choice(const accuracy::Chain& chain,
                                         const accuracy::Choice& choice);

// What is done when no budget is given: the default of gridding, advected, each sweep at its own
// time, the rule asked for, the default codes. The effects' settings change it.
[[nodiscard]] accuracy::Choice default_mosaic_choice(const accuracy::Chain& chain,
                                                     const grid::GridSpec& domain,
                                                     double beam_width_deg);

// How values are kept: the default; or in two bytes and steps of a 64th of it, of a 16th where the
// default has two bytes.
[[nodiscard]] grid::Quantization quantization_of(level2::Moment moment, bool fine);

// The choice's rungs among options that hold all else.
[[nodiscard]] PartialOptions with_choice(PartialOptions options, const MosaicChoice& choice);
[[nodiscard]] FrameOptions with_choice(FrameOptions options, const MosaicChoice& choice);

}  // namespace stormcellar::pipeline
