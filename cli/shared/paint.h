// cli/shared/paint.h -- color in the text of a terminal, so that trouble stands out.
//
// Thread contract: pure but for paint_for(), which reads the environment.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::cli {

enum class Paint { plain, colors };

// Colors are for a terminal alone: not if the descriptor is anything else, if NO_COLOR is set to
// anything (no-color.org), or if TERM is missing or "dumb".
[[nodiscard]] Paint paint_for(int descriptor);

// Color texts: bold red is for what has gone wrong, yellow for what may need a look. With
// Paint::plain a text stays as it is, and so does an empty one.
[[nodiscard]] std::string in_red(std::string_view text, Paint paint);
[[nodiscard]] std::string in_yellow(std::string_view text, Paint paint);

}  // namespace stormcellar::cli
