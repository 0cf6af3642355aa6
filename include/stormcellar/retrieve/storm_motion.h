// stormcellar/retrieve/storm_motion.h -- estimates the motion of storms from the wind profile, and
// subtracts a motion from radial velocities.
//
// Units     m/s; meters above the antenna, which count as meters above the ground. As text, a
//           motion is "240/15": the direction that the storm comes FROM, in degrees clockwise from
//           north, and its speed in m/s, as forecasters write it.
// Source    Bunkers et al. (2000): a supercell deviates by 7.5 m/s from the mean wind from 0 to 6
//           km, at right angles to the shear. The shear is the mean wind from 5.5 to 6 km minus the
//           mean wind from 0 to 500 m. The means are over height and not weighted by pressure.
// Accuracy  Exact for the given winds, which are linear in height between layers
//           (tests/retrieve/storm_motion_test.cpp). Not covered: storms that do not move as
//           Bunkers et al. found, and ground far above or below the radar.
// Errors    See each function.
// Threads   Pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::retrieve {

// Reads "240/15". Errors: bad_argument unless the direction is from 0 to 360 degrees, and the speed
// from 0 to 100 m/s.
[[nodiscard]] Result<Motion> parse_motion(std::string_view text);
// Returns "240/15", rounded to whole degrees and to 0.1 m/s.
[[nodiscard]] std::string format_motion(const Motion& motion);

struct StormMotions {
    Motion right, left;  // of the supercells that move to the right and to the left of the shear
    Motion mean;         // the mean wind from 0 to 6 km
};

struct WindAtHeight {
    double height_m = 0;
    Motion wind;
};

// Estimates the motions of supercells from winds at rising heights. The lowest wind holds down to
// the ground, and the highest up to 6 km. Errors: not_found, with the reason, if the lowest wind is
// above 500 m, the highest is below 5.5 km, two neighbors are more than `most_gap_m` apart, or the
// winds at 0 to 500 m and 5.5 to 6 km are the same, so that there is no shear.
[[nodiscard]] Result<StormMotions> bunkers_motions(std::span<const WindAtHeight> winds,
                                                   double most_gap_m = 3'000);
// Uses the layers that have a wind and in which birds are not likely. Neighbors may be at most 1500
// m apart. Errors: as above.
[[nodiscard]] Result<StormMotions> bunkers_motions(std::span<const WindLayer> layers);

// Returns the radial velocity of a gate relative to a storm.
[[nodiscard]] double storm_relative_mps(double velocity_mps, double azimuth_deg,
                                        double elevation_deg, const Motion& storm);

}  // namespace stormcellar::retrieve
