// stormcellar/base/station_table.h -- where the radars stand.
//
// All NEXRAD (WSR-88D) and TDWR sites that send Level II data. Used for volumes that carry no
// position and to check those that do. Sources: docs/data-sources.md.
// Accuracy: positions to about 0.001 deg (100 m), altitudes as published, to about 1 m, with
// exceptions named in docs/data-sources.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

[[nodiscard]] std::span<const Station> all_stations();  // of the table alone, sorted by icao
// Of the table, or else of those that were added. Exact, upper case.
[[nodiscard]] std::optional<Station> find_station(std::string_view icao);

// The station that the name of a file begins with, as in KTLX20240601_220000_V06, or in the names
// that NCEI gives, 6500KTLX19910720_160529.Z; in either case of letters. Empty where find_station()
// does not know it.
[[nodiscard]] std::string station_in_name(std::string_view file_name);

// A station that a configuration or a command line adds to the table. What the table has already
// stays as it is there, unless `instead_of_table` says otherwise.
struct AddedStation {
    std::string icao;
    std::string name;
    double latitude_deg = 0;
    double longitude_deg = 0;
    double antenna_altitude_m = 0;
    bool instead_of_table = false;
    bool operator==(const AddedStation&) const = default;
};
// From now on find_station() finds these, too, and no others that were added before. To be called
// before other threads ask for stations, and at most once while anybody holds a found one.
void set_added_stations(std::vector<AddedStation> stations);

// Whether a name may stand for a station: [A-Z][A-Z0-9]{3}. Only such names become file names.
[[nodiscard]] bool is_icao(std::string_view text);
// The name in capitals; none where it is no station's in either case.
[[nodiscard]] std::optional<std::string> icao_of(std::string_view text);

}  // namespace stormcellar
