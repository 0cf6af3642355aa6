// grid/sweep/sweep_stack.h -- the sweeps of a volume, prepared for one moment and one method of
// gridding.
//
// Threads   Immutable; many threads may use one object. The volume must outlive it.
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
    std::vector<PolarSweep> sweeps;  // in order of rising elevation, at least one
    std::vector<bool> adjacent_to_next;
    std::vector<float> elevations_deg;
    // True if every radial was measured higher than all radials of lower sweeps, and if no traced
    // beams cross or are much wider or narrower than their elevations imply (as in ducts).
    bool in_order = true;
    float beam_width_deg = 0.95F;
    std::size_t table_size = 2;  // number of arcs in the tables of each sweep
    float gate_spacing_m = 250;  // the largest of any sweep, at least 250
};

struct StackOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0.95;
    Method method;  // only its beam, averaging, on_circle and cell matter here
    // The profile for traced beams; none: the exponential reference atmosphere.
    std::optional<RefractivityProfile> profile = std::nullopt;
};

// Prepares the sweeps in `chosen`. There must be at least one.
[[nodiscard]] SweepStack make_stack(const level2::Volume& volume, const SitePosition& site,
                                    const std::vector<ChosenSweep>& chosen,
                                    const StackOptions& options);

// Returns the model of the beam. Traced beams use the profile, or the exponential reference
// atmosphere if there is none.
[[nodiscard]] BeamModel beam_model_of(const SitePosition& site, ChosenBeam kind,
                                      const std::optional<RefractivityProfile>& profile);

// Returns true if the station table says that the radar is a TDWR.
[[nodiscard]] bool is_tdwr(std::string_view icao);

}  // namespace stormcellar::grid
