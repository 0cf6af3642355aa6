// daemon/config/station_config.h -- reads the rule for the stations from which stormcellard accepts
// data: the key [ingest] stations of stormcellard.toml. base/added_stations.h reads the [[station]]
// tables.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string_view>

#include "base/toml_file.h"
#include "stormcellar/base/station_rule.h"

namespace stormcellar::daemon {

// Reads "known", "any" or a list of stations. If the key is missing, the rule is "known". Complains
// about invalid values.
[[nodiscard]] StationRule read_station_rule(TomlTable& ingest);

// Returns the name that the configuration uses: "known", "any" or "listed".
[[nodiscard]] std::string_view name_of(StationRule::Kind kind);

}  // namespace stormcellar::daemon
