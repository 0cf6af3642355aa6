// base/added_stations.h -- the [[station]] tables of a configuration: stations that are in no
// table. daemon/stormcellard.toml explains the keys.
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

// Says that a name has not the form of a station's: `"x" is not a station: give ...`.
[[nodiscard]] std::string no_station(const std::string& name);

}  // namespace stormcellar
