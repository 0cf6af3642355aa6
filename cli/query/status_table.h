// cli/query/status_table.h -- the daemon's status as text for people.
//
// Members that the document lacks, or has in another form than that of daemon/status/status_json.h,
// are shown as "-": a newer or older daemon is no error.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

// Returns "85 ms", "4.2 s", "42 s", "12 min", "3.2 h", "5 d" or "4.1 y"; "-" for none; with a minus
// for times in the future.
[[nodiscard]] std::string short_duration(std::optional<double> seconds);

// Returns several lines, with the stations sorted by name. Ages are counted from `now`.
[[nodiscard]] std::string status_table(const nlohmann::json& status, UtcTime now);

}  // namespace stormcellar::cli
