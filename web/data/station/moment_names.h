// web/data/station/moment_names.h -- the names of moments in FM 301 (CfRadial 2), as xradar 0.12
// and the Python package write them.
//
// Source    export/exchange_names.h; long names and units as in xradar.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <string_view>

#include "stormcellar/level2/moment.h"

namespace stormcellar::web {

struct MomentNames {
    std::string_view name = {};           // "DBZH"
    std::string_view standard_name = {};  // empty: none
    std::string_view long_name = {};      // empty: none
    std::string_view unit = {};
};
// Other moments, which no radar sends, have our own names and units.
[[nodiscard]] MomentNames fm301_names(level2::Moment moment);

}  // namespace stormcellar::web
