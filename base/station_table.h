// base/station_table.h -- where the radars stand.
//
// All NEXRAD (WSR-88D) and TDWR sites that send Level II data. Used for volumes that carry no
// position and to check those that do. Sources: docs/data-sources.md.
// Accuracy: positions to about 0.001 deg (100 m), altitudes as published, to about 1 m, with
// exceptions named in docs/data-sources.md.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace stormcellar {

enum class RadarKind { nexrad, tdwr };

struct Station {
    std::string_view icao;   // four characters, e.g. KTLX
    std::string_view name;   // place, e.g. Oklahoma City
    std::string_view state;  // two letters, or a country
    RadarKind kind = RadarKind::nexrad;
    double latitude_deg = 0;        // WGS84, north positive
    double longitude_deg = 0;       // WGS84, east positive
    double antenna_altitude_m = 0;  // of the feed horn, above mean sea level
};

[[nodiscard]] std::span<const Station> all_stations();                     // sorted by icao
[[nodiscard]] std::optional<Station> find_station(std::string_view icao);  // exact, upper case

// Whether a name may stand for a station: [A-Z][A-Z0-9]{3}. Only such names become file names.
[[nodiscard]] bool is_icao(std::string_view text);

}  // namespace stormcellar
