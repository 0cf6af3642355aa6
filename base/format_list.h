// base/format_list.h -- finds a file format by the ending of a file's name. A row of the table has
// a `name` ("JPEG") and its `endings` (".jpg", ".jpeg").
//
// Threads: pure functions.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/name_list.h"

namespace stormcellar {

// Returns the first format with an ending that the name has, or null.
template <class Format>
[[nodiscard]] const Format* find_format(std::span<const Format> formats,
                                        std::string_view file_name) {
    for (const Format& format : formats) {
        const auto fits = [&](std::string_view ending) { return file_name.ends_with(ending); };
        if (std::ranges::any_of(format.endings, fits)) return &format;
    }
    return nullptr;
}

template <class Format>
[[nodiscard]] std::vector<std::string_view> endings_in(std::span<const Format> formats) {
    std::vector<std::string_view> all;
    for (const Format& format : formats)
        all.insert(all.end(), format.endings.begin(), format.endings.end());
    return all;
}

// Returns a text for users: "PNG (.png) or JPEG (.jpg, .jpeg)".
template <class Format>
[[nodiscard]] std::string formats_in(std::span<const Format> formats) {
    struct Named {
        std::string name;
    };
    std::vector<Named> known;
    for (const Format& format : formats)
        known.push_back({fmt::format("{} ({})", format.name, fmt::join(format.endings, ", "))});
    return names_in(known, ", ", " or ");
}

}  // namespace stormcellar
