// base/toml_depth.h -- finds keys that make it unsafe to parse a TOML text.
//
// The parser makes a table for each part of a dotted key, and destroys the tables by recursion. So
// a key with a few hundred thousand parts, which fits into a file of 1 MiB, would crash the
// process. The parser itself limits the depth of arrays and inline tables. Used only inside the
// base room, by toml_file.cpp.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string_view>

namespace stormcellar {

constexpr int most_key_parts = 16;

// Returns the line, counted from 1, of the first key or section whose name has more than
// most_key_parts parts, or none. Skips strings and comments by the rules of TOML. In text that is
// not valid TOML, the result is right up to the first mistake, where the parser stops.
[[nodiscard]] std::optional<unsigned> line_of_deep_key(std::string_view toml);

}  // namespace stormcellar
