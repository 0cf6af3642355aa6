// base/printable.h -- makes text from outside safe for a terminal or a log.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns the length in bytes of the well-formed UTF-8 character at the start of `text`; 0 if there
// is none.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

// Replaces control characters, invisible characters, and bytes that are not UTF-8 by \xNN for each
// byte. For example, U+202E, which reverses the following text, becomes "\xe2\x80\xae". So the
// result is always one line and hides nothing. Invisible characters include variation selectors,
// and the joiners of emoji and of some scripts. Letters stay unchanged, even if their script runs
// from right to left, or if they look like letters of another alphabet.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace stormcellar
