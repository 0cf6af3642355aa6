// retrieve/melting/height_profile.h -- moments of dual polarization over height, from one sweep.
//
// Units     Meters above the antenna, dBZ, dB.
// Threads   Plain data and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

inline constexpr std::size_t profile_levels = 70;
inline constexpr double profile_step_m = 100;

[[nodiscard]] constexpr double level_height_m(double level) {
    return (level + 0.5) * profile_step_m;
}

// The sums of the stratiform gates between two heights.
struct LevelSums {
    std::vector<float> correlations;
    double reflectivity_sum = 0, zdr_sum = 0, range_sum_m = 0;
};
using SectorSums = std::array<LevelSums, profile_levels>;

// Adds up the gates of 15 to 47 dBZ with a correlation of at least 0.7 from a range of 5 km on, for
// each sector of MeltingLayer. Empty if the sweep lacks REF, ZDR or RHO.
[[nodiscard]] std::vector<SectorSums> sums_by_sector(const level2::Sweep& sweep);
// Returns the sums of the whole circle.
[[nodiscard]] SectorSums sums_of_circle(std::span<const SectorSums> sectors);

// The means of a level, and the standard deviation of height in the beam, whose two-way pattern is
// Gaussian. The correlation is the mean of the middle half of its values.
struct ProfileLevel {
    double correlation = 0, reflectivity_dbz = 0, zdr_db = 0, beam_m = 0;
};
// Levels with fewer than 8 gates have no means.
using HeightProfile = std::array<std::optional<ProfileLevel>, profile_levels>;

[[nodiscard]] HeightProfile height_profile(const SectorSums& sums);

}  // namespace stormcellar::retrieve
