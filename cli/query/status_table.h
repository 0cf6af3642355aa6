// cli/query/status_table.h -- formats the daemon's status as text for people.
//
// If the document lacks a member, or has it in another form than daemon/status/status_json.h, the
// table shows "-". So a newer or older daemon is not an error.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli/shared/paint.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

// Returns several lines, with the stations sorted by name. Ages are counted from `now`. With
// colors, problems are red and warnings are yellow; the text is the same without colors.
[[nodiscard]] std::string status_table(const nlohmann::json& status, UtcTime now,
                                       Paint paint = Paint::plain);

}  // namespace stormcellar::cli
