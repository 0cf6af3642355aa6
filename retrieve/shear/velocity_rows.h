// retrieve/shear/velocity_rows.h -- unfolded velocities of one moment of a sweep, in rows by
// azimuth.
//
// Units     m/s, meters, degrees.
// Threads   Plain data and pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

struct VelocityRows {
    std::size_t gates = 0;
    double first_gate_m = 0, gate_spacing_m = 0;
    double elevation_deg = 0;           // mean of the radials
    double azimuth_spacing_deg = 1;     // usual angle between radials
    double step_mps = 0;                // between adjacent codes
    std::vector<std::size_t> radials;   // of each row: its index in the sweep
    std::vector<float> azimuths_deg;    // of each row, rising, within [0, 360)
    std::vector<float> velocities_mps;  // rows x gates; NaN where there is none

    [[nodiscard]] float* row(std::size_t row) { return velocities_mps.data() + row * gates; }
    [[nodiscard]] const float* row(std::size_t row) const {
        return velocities_mps.data() + row * gates;
    }
    [[nodiscard]] std::size_t row_count() const { return radials.size(); }
    // Returns the range to the center of a gate.
    [[nodiscard]] double range_m(std::size_t gate) const {
        return first_gate_m + gate_spacing_m * static_cast<double>(gate);
    }
};

// Returns the velocities with certain fold numbers of the moment that `folds` names, up to a range.
// The fold numbers must have the moment's shape. There are no rows for radials without velocities
// or with an unknown Nyquist velocity, and no velocities nearer than 1 km.
[[nodiscard]] VelocityRows velocity_rows(const level2::Sweep& sweep, const SweepFolds& folds,
                                         double farthest_m);

}  // namespace stormcellar::retrieve
