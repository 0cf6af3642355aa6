#include "stormcellar/render/theme.h"

#include <array>
#include <string>
#include <vector>

#include "base/name_list.h"
#include "render/image/unknown_name.h"

namespace stormcellar::render {
namespace {

struct NamedTheme {
    Theme theme;
    std::string_view name;
};
constexpr std::array themes = {NamedTheme{Theme::dark, "dark"}, NamedTheme{Theme::light, "light"}};
static_assert(is_in_order(themes, &NamedTheme::theme));

}  // namespace

std::string_view theme_name(Theme theme) {
    return themes[static_cast<std::size_t>(theme)].name;
}

Result<Theme> theme_from_name(std::string_view name) {
    std::vector<std::string> names;
    for (const NamedTheme& known : themes) {
        if (known.name == name) return known.theme;
        names.emplace_back(known.name);
    }
    return unknown_name("theme", name, names, "themes are " + themes_for_help());
}

std::string themes_for_help() {
    return names_in(themes, ", ", " or ");
}

}  // namespace stormcellar::render
