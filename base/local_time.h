// base/local_time.h -- converts UTC to local time.
//
// Zones are those of the system's IANA database (package tzdata), by name: "America/Chicago". Past
// times follow the rules of their day.
//
// Threads   Any thread may call. TZ and the machine's zone are read and never set.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar {

// Returns "1999-05-03 18:56:21 CDT", in whole seconds, rounded down. Zones without an abbreviation
// give their offset, as in "-03". Errors: bad_argument for a name that is not a zone, unsupported
// if the database is missing.
[[nodiscard]] Result<std::string> format_local(UtcTime time, std::string_view zone);

// Returns the zone that TZ names, else that of /etc/localtime; empty if neither names a zone.
[[nodiscard]] std::string machine_time_zone();

}  // namespace stormcellar
