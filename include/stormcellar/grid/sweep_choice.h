// stormcellar/grid/sweep_choice.h -- which sweeps of a volume are gridded for a moment, and which
// of them are neighbours in the VCP.
//
// Sweeps whose fixed angles lie within 0.2 degrees are the same elevation; of each elevation one
// sweep is taken: among those that cover at least 90 % of the azimuths that the fullest covers, and
// of those that reach at least 90 % as far as the farthest, and, but for VEL and SW, of those whose
// unambiguous range is at least 90 % of the longest, the newest or the nearest to a time. So a
// split cut gives its surveillance sweep (its Doppler sweep for VEL and SW), SAILS and MRLE their
// latest, or that of the time asked for, and a sweep that broke off does not displace a whole one.
// The rules are explained in docs/geometry.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct ChosenSweep {
    std::size_t sweep_index = 0;         // into Volume::sweeps
    double elevation_deg = 0;            // the median of the radials' measured elevations
    double fixed_angle_deg = 0;          // the cut's in the VCP where that is known, else measured
    std::vector<std::uint32_t> radials;  // the radials to use, in file order
    std::size_t radials_off_elevation = 0;  // left out: more than half a beam from the median
    // How many sweeps of this elevation were equally fit, this one included; more than 1 for SAILS,
    // MRLE and the like.
    std::size_t repeats = 1;
    std::optional<UtcTime> median_time;  // of the radials to use; none when none is dated
    // Nothing of the VCP lies between this sweep and the next higher one that was chosen.
    bool adjacent_to_next = true;
};

// Rising elevation. Empty when no sweep holds the moment. Radials are used that hold the moment
// (with a scale by which no code can exceed 1e5), have finite angles, and were measured within
// `half_beam_deg` of the sweep's median elevation.
// Of sweeps that are equally fit the newest is taken: the last in the file; or, with `nearest_to`,
// the one whose median time is nearest to that, the later of two that are as near, undated ones
// only where none is dated.
[[nodiscard]] std::vector<ChosenSweep> choose_sweeps(
    const level2::Volume& volume, level2::Moment moment, double half_beam_deg,
    std::optional<UtcTime> nearest_to = std::nullopt);

// The fixed angles of the volume's VCP, rising: from message 5 or 7, else, by its number, one of
// the patterns of the years before message 5 was sent (11, 12, 21, 31, 32, 121). Empty: not known.
[[nodiscard]] std::vector<double> vcp_angles_deg(const level2::Volume& volume);

// Degrees from one radial to the next: the larger of what the radials say and the median step of
// their azimuths (at most 2). `azimuths_deg` must be sorted and within [0, 360).
[[nodiscard]] double azimuth_spacing_deg(std::span<const float> azimuths_deg, float stated_deg);

// [0, 360); none for what is no azimuth.
[[nodiscard]] std::optional<float> normal_azimuth(float azimuth_deg);

}  // namespace stormcellar::grid
