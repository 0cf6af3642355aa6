// base/number_list.h -- numbers in one text, with a separator between them: "1,2.5", "0.5:16:0.5".
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace stormcellar {

// At least one number, all finite; none when anything else stands in `text`, spaces included.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text,
                                                               char separator);

}  // namespace stormcellar
