// daemon/config/station_config.h -- which stations' data stormcellard.toml accepts: [ingest]
// stations and the [[station]] tables. daemon/stormcellard.toml explains them. Thread contract:
// pure functions.
#pragma once

#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::daemon {

// "known", "any" or a list of stations; if left out: known. Complains of anything else.
[[nodiscard]] StationRule read_station_rule(TomlTable& ingest);

// The rule as the configuration names it: "known", "any" or "listed".
[[nodiscard]] std::string_view name_of(StationRule::Kind kind);

// Reads all [[station]] tables; complains of invalid ones and leaves them out.
[[nodiscard]] std::vector<AddedStation> read_added_stations(TomlTable& root);

}  // namespace stormcellar::daemon
