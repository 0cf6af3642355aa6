// stormcellar/base/station_table.h -- positions of the radars.
//
// The table holds all NEXRAD (WSR-88D) and TDWR sites that send Level II data. It gives the
// position of volumes that carry none, and is used to check the position of those that do.
//
// Units     Degrees on WGS84, meters above mean sea level.
// Threads   Any thread may call every function except set_added_stations(); see there.
// Errors    None. An unknown station gives none or an empty text.
// Accuracy  Positions to about 0.001 degrees (100 m), altitudes as published, to about 1 m, with
//           the exceptions named in docs/data-sources.md.
// Source    docs/data-sources.md.
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

[[nodiscard]] std::span<const Station> all_stations();  // only the table, sorted by icao
// Returns the station of this name from the table, else from the added stations, else none. The
// name must match exactly, in upper case.
[[nodiscard]] std::optional<Station> find_station(std::string_view icao);

// Returns the station at the beginning of a file name, as in KTLX20240601_220000_V06, or in NCEI's
// names, 6500KTLX19910720_160529.Z. Otherwise it returns the station that is a word of the name, as
// in Level2_KTLX_19990503_2356.ar2v and 19990503_235621_KTLX.gz, or that begins a word before a
// date. Upper and lower case are alike. Returns an empty text if find_station() knows none of
// these, or if words name different stations.
[[nodiscard]] std::string station_in_name(std::string_view file_name);

// A station that a configuration or a command line adds to the table. If the table already has it,
// the table's entry stays, unless `instead_of_table` is set.
struct AddedStation {
    std::string icao;
    std::string name;
    double latitude_deg = 0;
    double longitude_deg = 0;
    double antenna_altitude_m = 0;
    bool instead_of_table = false;
    bool operator==(const AddedStation&) const = default;
};
// Replaces all added stations by these. Call it before other threads ask for stations, and at most
// once while any code holds a station that find_station() returned.
void set_added_stations(std::vector<AddedStation> stations);

// Returns true if a text has the form of a station's name, [A-Z][A-Z0-9]{3}. Only such names become
// names of files.
[[nodiscard]] bool is_icao(std::string_view text);
// Returns the name in capitals, or none if the text is not a station's name in either case.
[[nodiscard]] std::optional<std::string> icao_of(std::string_view text);

}  // namespace stormcellar
