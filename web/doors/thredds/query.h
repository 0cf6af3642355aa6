// web/doors/thredds/query.h -- a query of the THREDDS radar server: stations and times.
//
// Stations  stn=KTLX, repeated or with commas, or stn=all; or longitude and latitude, for the
//           nearest station; or north, south, east and west, for a box.
// Times     time, repeated: the nearest file of each station, within an hour; or two of time_start,
//           time_end and time_duration; or temporal=all.
// Variables var=N0Q, repeated or with commas.
//
// Threads   Pure functions.
// Errors    bad_argument, with a sentence for the client.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "web/http/request.h"

namespace stormcellar::web {

struct ThreddsQuery {
    struct Point {
        double latitude_deg = 0, longitude_deg = 0;
    };
    // If `west` is greater than `east`, the box crosses the 180th meridian.
    struct Box {
        double north_deg = 0, south_deg = 0, east_deg = 0, west_deg = 0;
    };
    // At most one of the following four fields is set.
    std::vector<std::string> stations;
    bool all_stations = false;
    std::optional<Point> near;
    std::optional<Box> box;

    // Either `times` is set, or the range from `from` to `to`. With temporal=all the range has no
    // ends.
    std::vector<UtcTime> times;
    std::optional<UtcTime> from, to;

    std::vector<std::string> variables;  // of each, the part before a '/'
};

inline constexpr std::size_t most_query_stations = 400, most_query_times = 100;

[[nodiscard]] Result<ThreddsQuery> read_thredds_query(const Request& request, UtcTime now);

// Returns true if the place is in the box.
[[nodiscard]] bool is_inside(const ThreddsQuery::Box& box, double latitude_deg,
                             double longitude_deg);

}  // namespace stormcellar::web
