// cli/query/status_table.h -- the daemon's status as text for people.
//
// Whatever the document lacks, or holds in another form than daemon/status/status_json.h says, is
// shown as
// "-": a newer or older daemon is no error. Thread contract: pure functions.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

// "85 ms", "4.2 s", "42 s", "12 min", "3.2 h", "5 d", "4.1 y"; "-" for none; a minus before what
// lies ahead.
[[nodiscard]] std::string short_duration(std::optional<double> seconds);

// Several lines, the stations sorted by name. Ages are counted from `now`.
[[nodiscard]] std::string status_table(const nlohmann::json& status, UtcTime now);

}  // namespace stormcellar::cli
