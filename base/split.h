// base/split.h -- splits a list in one text: "a,b".
//
// Threads: pure functions.
#pragma once

#include <string_view>
#include <vector>

namespace stormcellar {

// Returns the items between separators, one more than there are separators. Items may be empty.
[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> items;
    for (;;) {
        const std::size_t end = text.find(separator);
        items.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return items;
        text.remove_prefix(end + 1);
    }
}

}  // namespace stormcellar
