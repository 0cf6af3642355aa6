// cli/shared/short_duration.h -- formats a duration in a few characters for people.
//
// Thread contract: a pure function.
#pragma once

#include <optional>
#include <string>

namespace stormcellar::cli {

// Returns "85 ms", "4.2 s", "42 s", "12 min", "3.2 h", "5 d" or "4.1 y"; "-" for none. A negative
// duration has a minus.
[[nodiscard]] std::string short_duration(std::optional<double> seconds);

}  // namespace stormcellar::cli
