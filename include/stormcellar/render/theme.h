// stormcellar/render/theme.h -- the themes of a picture: a dark or a light page.
//
// A theme changes the page, the ground, lines and letters, never the colors of echo.
//
// Threads   Constants and pure functions.
// Errors    See theme_from_name().
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar::render {

enum class Theme { dark, light };

[[nodiscard]] std::string_view theme_name(Theme theme);
// Returns a theme by its name. Errors: bad_argument for any other name; the message gives the
// nearest name or lists all names.
[[nodiscard]] Result<Theme> theme_from_name(std::string_view name);
// Returns "dark or light".
[[nodiscard]] std::string themes_for_help();

}  // namespace stormcellar::render
