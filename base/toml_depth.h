// base/toml_depth.h -- checks whether text is TOML that is safe to parse.
//
// The parser makes a table for each part of a dotted key, and destroys them by recursion. A key
// with a few hundred thousand parts fits into a file of 1 MiB and would crash the process. The
// parser itself limits arrays and inline tables. This is used only inside the base room, by
// toml_file.cpp.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string_view>

namespace stormcellar {

constexpr int most_key_parts = 16;

// Returns the line, counted from 1, of the first key or section whose name has more parts than the
// limit, or none. Strings and comments are skipped by the rules of TOML. In text that is not TOML,
// this is right up to the first mistake, after which the parser reads nothing.
[[nodiscard]] std::optional<unsigned> line_of_deep_key(std::string_view toml);

}  // namespace stormcellar
