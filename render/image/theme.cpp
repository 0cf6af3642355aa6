#include "stormcellar/render/theme.h"

#include <array>
#include <string>
#include <vector>

#include "base/name_list.h"
#include "base/nearest_name.h"

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
    if (const std::string meant = did_you_mean(name, names); !meant.empty())
        return fail(ErrorCode::bad_argument, "there is no theme '{}'{}", name, meant);
    return fail(ErrorCode::bad_argument, "there is no theme '{}'; the known themes are {}", name,
                themes_for_help());
}

std::string themes_for_help() {
    return names_in(themes, ", ", " or ");
}

}  // namespace stormcellar::render
