// cli/velocity/profile_text.h -- writes a wind profile as a table and as JSON.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cli/velocity/station_profile.h"
#include "stormcellar/render/units.h"

namespace stormcellar::cli {

// Returns "VVP in layers of 200 m, from gates 5 to 35 km away".
[[nodiscard]] std::string method_text(const retrieve::WindProfileOptions& options);

// Returns the table, from the ground upward, with the storm motions below it. Heights are those of
// the middle of a layer above sea level. Neighboring layers without a wind share a line if their
// reason is the same.
[[nodiscard]] std::string profile_table(const StationProfile& profile,
                                        const retrieve::WindProfileOptions& options,
                                        const render::Units& units);

// Returns the profile in meters above sea level, m/s and degrees, whatever the units of the table.
[[nodiscard]] nlohmann::ordered_json profile_json(const StationProfile& profile);

}  // namespace stormcellar::cli
