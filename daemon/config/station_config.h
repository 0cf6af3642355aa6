// daemon/config/station_config.h -- the stations from which stormcellard accepts data: [ingest]
// stations and the [[station]] tables of stormcellard.toml. daemon/stormcellard.toml explains them.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::daemon {

// Reads "known", "any" or a list of stations; if missing: known. Invalid values are reported.
[[nodiscard]] StationRule read_station_rule(TomlTable& ingest);

// Returns the name that the configuration uses: "known", "any" or "listed".
[[nodiscard]] std::string_view name_of(StationRule::Kind kind);

// Reads all [[station]] tables. Invalid ones are reported and left out.
[[nodiscard]] std::vector<AddedStation> read_added_stations(TomlTable& root);

}  // namespace stormcellar::daemon
