// stormcellar/base/station_table.h -- positions of the radars.
//
// The table has all NEXRAD (WSR-88D) and TDWR sites that send Level II data. It provides the
// position for volumes that contain none, and is used to check the position in other volumes.
//
// Units     Degrees on WGS84, meters above mean sea level.
// Threads   Any thread may call every function except set_added_stations(); see there.
// Errors    None. For an unknown station, a function returns none or an empty text.
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
// Returns the station of this name from the table, or else from the added stations, or none. An
// added station with `instead_of_table` comes before the table. The name must be in upper case.
[[nodiscard]] std::optional<Station> find_station(std::string_view icao);

// Returns the station with which a file name begins, as in KTLX20240601_220000_V06 or, in NCEI's
// names, 6500KTLX19910720_160529.Z. Otherwise looks for a station in the words of the name: a whole
// word, as in Level2_KTLX_19990503_2356.ar2v and 19990503_235621_KTLX.gz, or the start of a word
// before a digit. Ignores case. Returns an empty text if find_station() knows none of these, or if
// words name different stations.
[[nodiscard]] std::string station_in_name(std::string_view file_name);

// A station that a configuration or a command line adds to the table. If the table already has the
// station, find_station() returns the added station only if `instead_of_table` is set.
struct AddedStation {
    std::string icao;
    std::string name;
    double latitude_deg = 0;
    double longitude_deg = 0;
    double antenna_altitude_m = 0;
    bool instead_of_table = false;
    bool operator==(const AddedStation&) const = default;
};
// Replaces all added stations by these. Call it before other threads ask for stations. A second
// call invalidates the texts of all added stations that find_station() has returned.
void set_added_stations(std::vector<AddedStation> stations);

// Returns true if a text has the form of a station's name, [A-Z][A-Z0-9]{3}. Only such names are
// used as names of files.
[[nodiscard]] bool is_icao(std::string_view text);
// Returns the text in upper case, or none if that does not have the form of a station's name.
[[nodiscard]] std::optional<std::string> icao_of(std::string_view text);

}  // namespace stormcellar
