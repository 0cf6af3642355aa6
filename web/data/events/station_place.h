// web/data/events/station_place.h -- where a station is.
//
// The station table and the configuration know most stations. A test bed or a new radar is placed
// by its files alone: its newest grid says where they have it.
//
// Threads   Pure functions of the table and the cache.
// Errors    A station whose place nobody knows has none.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/station_table.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

struct StationPlace {
    std::string name, state;        // empty: not known
    std::optional<RadarKind> kind;  // none: not known
    double latitude_deg = 0, longitude_deg = 0, antenna_altitude_m = 0;
};

// `grids` may be null. A station that is not in the table may open its newest grid.
[[nodiscard]] std::optional<StationPlace> place_of_station(Grids* grids, std::string_view icao);

}  // namespace stormcellar::web
