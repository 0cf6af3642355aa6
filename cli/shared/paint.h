// cli/shared/paint.h -- colors trouble in text for a terminal.
//
// Thread contract: pure but for paint_for(), which reads the environment.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::cli {

enum class Paint { plain, colors };

// Returns color only for a terminal, and not if NO_COLOR is set to anything (no-color.org), or if
// TERM is missing or "dumb".
[[nodiscard]] Paint paint_for(int descriptor);

// Return the text in bold red, for errors, or in yellow, for warnings. With Paint::plain they
// return it unchanged, and so an empty text.
[[nodiscard]] std::string in_red(std::string_view text, Paint paint);
[[nodiscard]] std::string in_yellow(std::string_view text, Paint paint);

}  // namespace stormcellar::cli
