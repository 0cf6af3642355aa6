#include "stormcellar/render/light.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>

#include "base/split.h"
#include "render/image/unknown_name.h"

namespace stormcellar::render {
namespace {

struct Named {
    std::string_view name;
    bool Light::*field;
};
constexpr std::array<Named, 3> kinds = {{{"gradient", &Light::gradient},
                                         {"shadow", &Light::shadow},
                                         {"scattering", &Light::scattering}}};

Status unknown_light(std::string_view name) {
    std::vector<std::string> known{"none"};
    for (const Named& kind : kinds)
        known.emplace_back(kind.name);
    return unknown_name("light", name, known, fmt::format("kinds are {}", fmt::join(known, ", ")));
}

}  // namespace

Status set_light(const std::string& names, Light& light) {
    Light set = light;
    for (const Named& kind : kinds)
        set.*kind.field = false;
    for (const std::string_view name : split(names, ',')) {
        if (names == "none") break;
        if (name == "none") {
            return fail(ErrorCode::bad_argument,
                        "none cannot be combined with other kinds of light, as in '{}'", names);
        }
        const auto* const kind = std::ranges::find(kinds, name, &Named::name);
        if (kind == kinds.end()) return unknown_light(name);
        set.*kind->field = true;
    }
    light = set;
    return {};
}

std::string light_names(const Light& light) {
    std::string names;
    for (const Named& kind : kinds) {
        if (!(light.*kind.field)) continue;
        if (!names.empty()) names += ',';
        names += kind.name;
    }
    return names.empty() ? "none" : names;
}

}  // namespace stormcellar::render
