// base/local_time.h -- UTC as clocks on a wall show it.
//
// Zones are those of the system's IANA database (package tzdata), by name: "America/Chicago".
// Past times go by the rules of their day.
// Thread contract: may be called from any thread; TZ and the machine's zone are read, never set.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar {

// "1999-05-03 18:56:21 CDT", whole seconds, rounded down; zones without letters of their own give
// their distance, as in "-03". bad_argument for a name that is no zone, unsupported where the
// database is missing.
[[nodiscard]] Result<std::string> format_local(UtcTime time, std::string_view zone);

// What TZ names, else what /etc/localtime is; empty when neither names a zone.
[[nodiscard]] std::string machine_time_zone();

}  // namespace stormcellar
