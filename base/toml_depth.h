// base/toml_depth.h -- whether text is TOML that is safe to parse.
//
// The parser makes a table of each part of a dotted key, and takes them apart by recursion: a key
// of a few hundred thousand parts, as fits into a file of a MiB, ends the process. Arrays and
// inline tables it limits itself. Inside the base room, for toml_file.cpp.
#pragma once

#include <optional>
#include <string_view>

namespace stormcellar {

constexpr int most_key_parts = 16;

// The line of the first key or section whose name has more parts than that, counted from 1; none.
// Strings and comments are passed over as TOML has them. In text that is not TOML this is right up
// to the first mistake, behind which the parser reads nothing.
[[nodiscard]] std::optional<unsigned> line_of_deep_key(std::string_view toml);

}  // namespace stormcellar
