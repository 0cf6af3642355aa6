// base/printable.h -- makes text from outside safe for a terminal or a log.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns the length of the well-formed UTF-8 character at the start of `text`; 0 if there is none.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

// Writes control characters, characters that no glyph shows, and bytes that are not UTF-8 as \xNN,
// byte by byte. U+202E, which reverses what follows it, becomes "\xe2\x80\xae". So a name is always
// one line and hides nothing. This includes variation selectors, and the joiners of emoji and of
// some scripts. Letters stay as they are, including those of scripts that run from right to left
// and those that look alike in two alphabets.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace stormcellar
