// daemon/config/station_config.h -- which stations stormcellard.toml takes data of: [ingest]
// stations and the [[station]] tables. daemon/stormcellard.toml explains them. Thread contract:
// pure functions.
#pragma once

#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::daemon {

// "known", "any" or a list of stations; left out: known. What makes no sense is complained of.
[[nodiscard]] StationRule read_station_rule(TomlTable& ingest);

// As the configuration names it: "known", "any" or "listed".
[[nodiscard]] std::string_view name_of(StationRule::Kind kind);

// All [[station]] tables; what makes no sense is complained of and left out.
[[nodiscard]] std::vector<AddedStation> read_added_stations(TomlTable& root);

}  // namespace stormcellar::daemon
