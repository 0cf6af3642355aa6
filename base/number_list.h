// base/number_list.h -- parses numbers with a separator between them: "1,2.5", "0.5:16:0.5".
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace stormcellar {

// Returns the numbers in the text, at least one and all finite. Returns none if the text contains
// anything else, even a space.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text,
                                                               char separator);

}  // namespace stormcellar
