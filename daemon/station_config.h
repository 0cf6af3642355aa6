// daemon/station_config.h -- which stations stormcellard.toml takes data of: [ingest] stations and
// the [[station]] tables. daemon/stormcellard.toml explains them.
// Thread contract: pure functions.
#pragma once

#include <vector>

#include "base/station_rule.h"
#include "base/station_table.h"
#include "base/toml_file.h"

namespace stormcellar::daemon {

// "known", "any" or a list of stations; left out: known. What makes no sense is complained of.
[[nodiscard]] StationRule read_station_rule(TomlTable& ingest);

// All [[station]] tables; what makes no sense is complained of and left out.
[[nodiscard]] std::vector<AddedStation> read_added_stations(TomlTable& root);

}  // namespace stormcellar::daemon
