// base/nearest_name.h -- the name that a misspelled word most likely means, for messages.
//
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns how many insertions, deletions, replacements and exchanges of two neighboring bytes lead
// from one text to the other, where no part is edited twice.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the nearest of the names, whatever the case of their letters. None: no name is near, as
// more than a third of its letters, and more than one, would have to change. Of names that are
// equally near it is the first.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word,
                                                      std::span<const std::string> names);

// Returns "; did you mean 'volume'?", or an empty text if no name is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace stormcellar
