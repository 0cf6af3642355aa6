// cli/picture/picture.h -- what `frame` and `loop` have in common beside the scene.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

using Clock = std::chrono::steady_clock;
[[nodiscard]] double seconds_since(Clock::time_point start);

// Says on stderr that no grid of the moment matched, and which domains there are, or which moments
// the domain keeps; gives the exit status. `when` is empty or as " at or before 2005-08-22".
int report_no_grid(const cache::StoreReader& store, const std::string& domain,
                   level2::Moment moment, const std::string& when);

// Metadata of pictures is ASCII, names of files may be anything.
[[nodiscard]] std::string ascii(std::string_view text);

}  // namespace stormcellar::cli
