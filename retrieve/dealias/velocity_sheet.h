// retrieve/dealias/velocity_sheet.h -- cuts velocities into sheets, each of which can be unfolded
// as a whole. A sheet has consecutive radials of a sweep with one Nyquist velocity and one gate
// geometry.
//
// Units     A turn is twice the Nyquist velocity. A velocity of x turns may really be x + n turns
//           for any whole n, the fold number. Ranges in meters, angles in degrees.
// Threads   Plain data and pure functions.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Range of Nyquist velocities. Values outside it are damage, because no radar has them.
inline constexpr float least_nyquist_mps = 1, most_nyquist_mps = 200;

// Returns true if the Nyquist velocity is within this range, and the angles are finite.
[[nodiscard]] bool can_be_unfolded(const level2::Radial& radial);

// Returns the difference of two velocities, or 0 if one has no value, so that the caller may
// compare the result (base/floating_point.h).
[[nodiscard]] inline float turns_apart(float a, float b) {
    const float apart = std::abs(a - b);
    return std::isnan(apart) ? 0 : apart;
}

struct VelocitySheet {
    std::size_t sweep = 0;   // index in the volume
    std::size_t moment = 0;  // index in the sweep
    std::size_t first_radial = 0;
    int radials = 0;
    int gates = 0;
    double first_gate_m = 0, gate_spacing_m = 0;
    double turn_mps = 0;
    double elevation_deg = 0;  // mean of the radials
    bool is_circle = false;    // the last radial is beside the first
    UtcTime time;              // of the middle radial
    std::vector<float> azimuths_deg;
    std::vector<float> turns;  // radials x gates; NaN where a gate has no value

    [[nodiscard]] const float* row(int radial) const {
        return turns.data() + static_cast<std::size_t>(radial) * static_cast<std::size_t>(gates);
    }
    [[nodiscard]] std::size_t at(int radial, int gate) const {
        return static_cast<std::size_t>(radial) * static_cast<std::size_t>(gates) +
               static_cast<std::size_t>(gate);
    }
};

// Returns the sheets of all moments VEL, in the order of the volume. Leaves out sheets without
// a value, and radials for which can_be_unfolded() is false.
[[nodiscard]] std::vector<VelocitySheet> velocity_sheets(const level2::Volume& volume);
// Returns the sheets of one moment of a sweep, for which VelocitySheet::sweep is 0; none unless the
// moment is VEL or VELD. The turns of VELD may be any number, and its ambiguous gates have no
// value.
[[nodiscard]] std::vector<VelocitySheet> velocity_sheets(const level2::Sweep& sweep,
                                                         std::size_t moment);

// Drops the gates beyond the last gate at which any radial has a value. High sweeps have many such
// gates.
void drop_empty_gates(VelocitySheet& sheet);

}  // namespace stormcellar::retrieve
