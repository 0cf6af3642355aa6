// grid/sweep/sweep_stack.h -- the sweeps of a volume made ready for one moment and one way to grid
// it.
//
// Refers to the volume, which must outlive it. Immutable; use it from many threads.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "grid/sweep/polar_sweep.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/refractivity.h"
#include "stormcellar/grid/sweep_choice.h"

namespace stormcellar::grid {

struct SweepStack {
    std::vector<PolarSweep> sweeps;  // rising elevation, at least one
    std::vector<bool> adjacent_to_next;
    std::vector<float> elevations_deg;
    // No radial of a sweep was measured as high as one of a sweep above it, and no traced beams
    // cross or are much wider or narrower than their elevations say.
    bool in_order = true;
    float beam_width_deg = 0.95F;
    std::size_t table_size = 2;  // of each sweep's tables of arc
    float gate_spacing_m = 250;  // the largest
};

struct StackOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0.95;
    Method method;  // beam, averaging and circle count
    // For traced beams; none: the exponential reference atmosphere.
    std::optional<RefractivityProfile> profile = std::nullopt;
};

// `chosen` holds at least one sweep.
[[nodiscard]] SweepStack make_stack(const level2::Volume& volume, const SitePosition& site,
                                    const std::vector<ChosenSweep>& chosen,
                                    const StackOptions& options);

// The profile is for traced beams; none: the exponential reference atmosphere.
[[nodiscard]] BeamModel beam_model_of(const SitePosition& site, ChosenBeam kind,
                                      const std::optional<RefractivityProfile>& profile);

// By the station table.
[[nodiscard]] bool is_tdwr(std::string_view icao);

}  // namespace stormcellar::grid
