// cli/velocity/profile_text.h -- writes a wind profile as a table.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "retrieve/wind/station_profile.h"
#include "stormcellar/render/units.h"

namespace stormcellar::cli {

// Returns "VVP in layers of 200 m, from gates 5 to 35 km away".
[[nodiscard]] std::string method_text(const retrieve::WindProfileOptions& options);

// Returns the table, from the ground upward, with the storm motions below it. Heights are those of
// the middle of a layer above sea level. Neighboring layers without a wind share a line if their
// reason is the same.
[[nodiscard]] std::string profile_table(const retrieve::StationProfile& profile,
                                        const retrieve::WindProfileOptions& options,
                                        const render::Units& units);

}  // namespace stormcellar::cli
