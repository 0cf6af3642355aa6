// stormcellar/render/theme.h -- whether a picture is drawn on a dark or on a light page.
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
// Returns bad_argument, which lists the names, for any other name.
[[nodiscard]] Result<Theme> theme_from_name(std::string_view name);
// Returns "dark or light".
[[nodiscard]] std::string themes_for_help();

}  // namespace stormcellar::render
