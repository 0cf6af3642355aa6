// base/printable.h -- text from outside made fit for a terminal or a log.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar {

// Control characters and bytes that are not UTF-8 as \xNN, so that a name is always one line.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace stormcellar
