// retrieve/wind/station_profile.h -- the wind profile of one volume with its place and time, in the
// form of a table and of JSON.
//
// Units     As in wind_profile.h. The JSON has meters above sea level, m/s and degrees.
// Errors    See station_profile().
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/retrieve/storm_motion.h"
#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::retrieve {

struct StationProfile {
    std::string file;             // name of the file, without directories
    std::string station;          // empty: unknown
    std::optional<UtcTime> time;  // start of the volume
    double antenna_altitude_m = 0;
    std::vector<WindLayer> layers;  // heights above the antenna
    Result<StormMotions> motions = StormMotions{};

    [[nodiscard]] bool has_wind() const;
};

// Unfolds the velocities by the rung `anchored` and measures the wind. Errors: not_found if the
// position of the radar is unknown; those of wind_profile().
[[nodiscard]] Result<StationProfile> station_profile(const level2::Volume& volume, std::string file,
                                                     const WindProfileOptions& options = {});

[[nodiscard]] nlohmann::ordered_json profile_json(const StationProfile& profile);

}  // namespace stormcellar::retrieve
