// base/added_stations.h -- reads the [[station]] tables of a configuration, which add stations to
// the station table. daemon/stormcellard.toml explains the keys.
//
// Threads   Plain functions. One thread at a time reads a file's tables.
#pragma once

#include <string>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar {

// Reads the [[station]] tables, at most 512. Complains about invalid values and records the keys as
// read, so check TomlFile::finish(). Leaves out stations without a usable `icao`; a station with a
// bad coordinate is returned with 0 for that coordinate.
[[nodiscard]] std::vector<AddedStation> read_added_stations(TomlTable& root);

// Returns the message about a name that does not have the form of a station's name: `"x" is not a
// station: give ...`.
[[nodiscard]] std::string no_station(const std::string& name);

}  // namespace stormcellar
