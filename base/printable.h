// base/printable.h -- text from outside made fit for a terminal or a log.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar {

// Control characters, characters that no glyph shows, and bytes that are not UTF-8 are written as
// \xNN, byte by byte: U+202E, which turns around what follows it, is "\xe2\x80\xae". So a name is
// always one line and hides nothing. That takes in variation selectors and the joiners of emoji and
// of some scripts. Letters are left as they are, also those of scripts that run from right to left
// and those that look alike in two alphabets.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace stormcellar
