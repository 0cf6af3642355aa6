#include "stormcellar/render/light.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>

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
    std::string_view rest = names;
    while (names != "none") {
        const std::string_view name = rest.substr(0, rest.find(','));
        bool known = false;
        for (const Named& kind : kinds) {
            if (kind.name != name) continue;
            set.*kind.field = true;
            known = true;
        }
        if (name == "none") {
            return fail(ErrorCode::bad_argument,
                        "none cannot be combined with other kinds of light, as in '{}'", names);
        }
        if (!known) return unknown_light(name);
        if (name.size() == rest.size()) break;
        rest.remove_prefix(name.size() + 1);
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
