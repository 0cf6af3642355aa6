// render/options/moment_name.h -- finds the moment that a command line, a scene file or an address
// names.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::render {

// Finds a moment by its name in upper or lower case. Errors: bad_argument; the message lists the
// moments.
[[nodiscard]] Result<level2::Moment> moment_named(const std::string& text);

}  // namespace stormcellar::render
