// stormcellar/grid/sweep_choice.h -- chooses the sweeps of a volume to grid for a moment, and tells
// which chosen sweeps are neighbors in the VCP.
//
// Sweeps whose fixed angles differ by at most 0.2 degrees have the same elevation. One sweep of
// each elevation is chosen. Three filters, one after another, keep the candidates
// - that cover at least 90 % of the azimuths of the fullest candidate,
// - that reach at least 90 % as far as the farthest candidate, and
// - whose unambiguous range is at least 90 % of the longest (not for VEL and SW).
// The newest remaining candidate is chosen, or, if a time is given, the candidate nearest to that
// time. So a split cut yields its surveillance sweep (for VEL and SW its Doppler sweep), SAILS and
// MRLE yield their latest sweep or the sweep nearest to that time, and a sweep that broke off does
// not displace a whole one. docs/geometry.md explains the rules.
//
// Units     Degrees.
// Threads   Plain values and pure functions.
// Errors    None; a volume without the moment has no sweeps.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct ChosenSweep {
    std::size_t sweep_index = 0;  // index in Volume::sweeps
    double elevation_deg = 0;     // the median of the measured elevations of the radials
    // the VCP's angle for the cut if it is plausible, else `elevation_deg`
    double fixed_angle_deg = 0;
    std::vector<std::uint32_t> radials;     // the radials to use, in file order
    std::size_t radials_off_elevation = 0;  // radials not used: off by over half a beam
    // The number of equally good sweeps of this elevation, including this one. It is more than 1
    // for SAILS, MRLE and the like.
    std::size_t repeats = 1;
    std::optional<UtcTime> median_time;  // of the radials to use; none if no radial has a time
    // True if the VCP has no cut between this sweep and the next higher chosen sweep.
    bool adjacent_to_next = true;
};

// Chooses the sweeps, in order of rising elevation. The result is empty if no sweep holds the
// moment. A radial is used if it holds the moment (with a scale by which no code exceeds 1e5), has
// plausible angles, and was measured within `half_beam_deg` of the median elevation of its sweep.
//
// Without `nearest_to`, the newest of equally good sweeps is chosen, which is the last in the file.
// With `nearest_to`, the sweep with the median time nearest to it is chosen, or the later sweep if
// two are equally near. A sweep without times is chosen only if no sweep has times.
[[nodiscard]] std::vector<ChosenSweep> choose_sweeps(
    const level2::Volume& volume, level2::Moment moment, double half_beam_deg,
    std::optional<UtcTime> nearest_to = std::nullopt);

// Returns the sweep with this index in Volume::sweeps, with its radials chosen as by
// choose_sweeps(). Returns none if there is no such sweep, or no radial to use. `repeats` and
// `adjacent_to_next` keep their defaults.
[[nodiscard]] std::optional<ChosenSweep> sweep_by_number(const level2::Volume& volume,
                                                         std::size_t number, level2::Moment moment,
                                                         double half_beam_deg);

// Returns the fixed angles of the volume's VCP, rising, from message 5 or 7. Without a message, the
// number of the VCP selects one of the patterns from before message 5 existed (11, 12, 21, 31, 32,
// 121). The result is empty if the angles are unknown.
[[nodiscard]] std::vector<double> vcp_angles_deg(const level2::Volume& volume);

// Returns the angle from one radial to the next: the larger of the stated spacing and the median
// step of the azimuths, at most 2 degrees; 1 if neither is above 0. `azimuths_deg` must be sorted
// and within [0, 360).
[[nodiscard]] double azimuth_spacing_deg(std::span<const float> azimuths_deg, float stated_deg);

// Returns the azimuth turned into [0, 360), or none unless it is within -360 to 720.
[[nodiscard]] std::optional<float> normal_azimuth(float azimuth_deg);

}  // namespace stormcellar::grid
