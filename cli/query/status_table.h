// cli/query/status_table.h -- the daemon's status as text for people.
//
// Whatever the document lacks, or holds in another form than daemon/status/status_json.h says, is
// shown as
// "-": a newer or older daemon is no error. Thread contract: pure functions.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

// Several lines, the stations sorted by name. Ages are counted from `now`.
[[nodiscard]] std::string status_table(const nlohmann::json& status, UtcTime now);

}  // namespace stormcellar::cli
