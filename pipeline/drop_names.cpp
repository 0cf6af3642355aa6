#include "pipeline/drop_names.h"

#include <algorithm>
#include <array>

namespace stormcellar::pipeline {

bool is_temporary_name(std::string_view name) {
    static constexpr std::array<std::string_view, 6> endings = {"~",     ".tmp",     ".temp",
                                                                ".part", ".partial", ".filepart"};
    if (name.empty() || name.front() == '.') return true;
    return std::any_of(endings.begin(), endings.end(),
                       [&](std::string_view ending) { return name.ends_with(ending); });
}

}  // namespace stormcellar::pipeline
