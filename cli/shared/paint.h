// cli/shared/paint.h -- colors trouble in text for a terminal.
//
// Thread contract: pure but for paint_for(), which reads the environment.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::cli {

enum class Paint { plain, colors };

// Returns Paint::colors only for a terminal. Returns Paint::plain if NO_COLOR is set to any text
// (no-color.org), or if TERM is missing or "dumb".
[[nodiscard]] Paint paint_for(int descriptor);

// Return the text in bold red, for errors, or in yellow, for warnings. An empty text, or a text
// with Paint::plain, stays unchanged.
[[nodiscard]] std::string in_red(std::string_view text, Paint paint);
[[nodiscard]] std::string in_yellow(std::string_view text, Paint paint);

}  // namespace stormcellar::cli
