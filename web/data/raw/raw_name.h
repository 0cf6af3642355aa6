// web/data/raw/raw_name.h -- the names under which raw volumes are served.
//
// These are the names of the public bucket: KTLX20220317_000842_V06, followed by .gz if the file is
// compressed as a whole. The version is taken from the name of the dropped file if that name has
// this form. Otherwise it is _V06, or _V08 for a TDWR.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::web {

[[nodiscard]] std::string raw_name(std::string_view station, UtcTime start,
                                   std::string_view file_name);

// Returns the time in a name of this station, which is "KTLX20220317_000842" with anything behind
// it. Returns none if the name does not begin with the station and a time.
[[nodiscard]] std::optional<UtcTime> time_of_raw_name(std::string_view station,
                                                      std::string_view name);
// Returns true if the name is STATION and start, without an ending. Grids name volumes in this way.
// The name identifies the volume, whatever the name of its file is (level2::volume_name()).
[[nodiscard]] bool is_volume_name(std::string_view station, std::string_view name);
// Returns the first date and time in a name of any form, such as Level2_KTLX_20220317_0008.ar2v.
[[nodiscard]] std::optional<UtcTime> time_in_file_name(std::string_view name);

}  // namespace stormcellar::web
