// cli/shared/paint.h -- colors errors and warnings in text for a terminal.
//
// Thread contract: pure functions, except paint_for(), which reads the environment.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::cli {

enum class Paint { plain, colors };

// Returns Paint::colors if the descriptor is a terminal, else Paint::plain. Also returns
// Paint::plain if NO_COLOR is set to any text (no-color.org), or if TERM is missing or "dumb".
[[nodiscard]] Paint paint_for(int descriptor);

// Return the text in bold red for errors, or in yellow for warnings. Return an empty text, or any
// text with Paint::plain, unchanged.
[[nodiscard]] std::string in_red(std::string_view text, Paint paint);
[[nodiscard]] std::string in_yellow(std::string_view text, Paint paint);

}  // namespace stormcellar::cli
