#include "render/options/moment_name.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"

namespace stormcellar::render {

Result<level2::Moment> moment_named(const std::string& text) {
    std::string name = text;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (const auto moment = level2::moment_from_name(name)) return *moment;
    std::vector<std::string> names;
    for (const level2::MomentFacts& facts : level2::moment_facts)
        names.emplace_back(facts.name);
    return fail(ErrorCode::bad_argument, "must be {}, not '{}'{}",
                level2::moment_names(", ", " or "), printable(text), did_you_mean(text, names));
}

}  // namespace stormcellar::render
