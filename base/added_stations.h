// base/added_stations.h -- reads the [[station]] tables of a configuration, which add stations to
// the station table. daemon/stormcellard.toml explains the keys.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar {

// Reads all [[station]] tables. Invalid ones are reported and left out.
[[nodiscard]] std::vector<AddedStation> read_added_stations(TomlTable& root);

// Returns the message for a name that does not have a station's form: `"x" is not a station: give
// ...`.
[[nodiscard]] std::string no_station(const std::string& name);

}  // namespace stormcellar
