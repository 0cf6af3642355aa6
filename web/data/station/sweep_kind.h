// web/data/station/sweep_kind.h -- tells the sweeps of a volume apart, so that volumes can be
// compared.
//
// Two sweeps are of one kind if their angles differ by at most 0.15 degrees, both or neither
// measure velocity, and their azimuths and gates are spaced alike.
//
// Units     Degrees, meters.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::web {

struct SweepKind {
    double angle_deg = 0;
    bool has_velocity = false;
    double azimuth_spacing_deg = 1;  // 0.5 or 1
    // The gates of the moment with the finest gates.
    std::int32_t first_gate_m = 0, gate_spacing_m = 0;

    [[nodiscard]] bool is_like(const SweepKind& other) const;
};

// Returns the angle of the pattern, or the mean of the radials if the file does not have it.
[[nodiscard]] double fixed_angle_of(const level2::Sweep& sweep);
// Returns the first array of each moment, in the order of the sweep.
[[nodiscard]] std::vector<const level2::SweepMoment*> first_arrays(const level2::Sweep& sweep);
// Returns the array with the finest gates. The sweep must have a moment.
[[nodiscard]] const level2::SweepMoment& finest_array(const level2::Sweep& sweep);
// Returns the kind of a sweep, which must have radials and moments.
[[nodiscard]] SweepKind kind_of_sweep(const level2::Sweep& sweep);

// Returns the sweeps that have radials and moments, one for each cut of the pattern. If the radar
// restarted a cut, returns the try with the most radials.
[[nodiscard]] std::vector<const level2::Sweep*> cuts_of(const level2::Volume& volume);

}  // namespace stormcellar::web
