// web/data/events/station_place.h -- finds where a station is.
//
// The places of most stations are in the station table and the configuration. The place of another
// station, such as a test bed or a new radar, is read from its newest grid.
//
// Threads   Pure functions of the table and the cache.
// Errors    None. Returns none for a station whose place is unknown.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/station_table.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

struct StationPlace {
    std::string name, state;        // empty: unknown
    std::optional<RadarKind> kind;  // none: unknown
    double latitude_deg = 0, longitude_deg = 0, antenna_altitude_m = 0;
};

// Returns the place of a station. `grids` may be null. May open the newest grid of a station that
// is not in the table.
[[nodiscard]] std::optional<StationPlace> place_of_station(Grids* grids, std::string_view icao);

}  // namespace stormcellar::web
