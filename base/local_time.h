// base/local_time.h -- converts UTC to local time.
//
// The names of zones, such as "America/Chicago", are those of the system's IANA database (package
// tzdata). The conversion uses the rules that the zone has at the converted time.
//
// Threads   Any thread may call. TZ and the machine's zone are read and never set.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar {

// Returns "1999-05-03 18:56:21 CDT", rounded down to seconds. Zones without an abbreviation have
// their offset instead, as in "-03". Errors: bad_argument for a name that is not a zone,
// unsupported if the database is missing.
[[nodiscard]] Result<std::string> format_local(UtcTime time, std::string_view zone);

// Returns the zone in TZ or, if TZ is not set or empty, the zone of /etc/localtime. Returns an
// empty text if the database has no zone of this name.
[[nodiscard]] std::string machine_time_zone();

}  // namespace stormcellar
