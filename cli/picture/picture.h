// cli/picture/picture.h -- code that `frame` and `loop` share besides the scene.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

// Reports on stderr that no grid of the moment matched. Names the domains that exist, or the
// moments that the domain has. `when` is empty or a text such as " at or before 2005-08-22".
// Returns the exit status.
int report_no_grid(const cache::StoreReader& store, const std::string& domain,
                   level2::Moment moment, const std::string& when);

}  // namespace stormcellar::cli
