// base/nearest_name.h -- finds the name that a misspelled word most likely means, for messages.
//
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns how many insertions, deletions, replacements and exchanges of two neighboring bytes turn
// one text into the other, where no part is edited twice.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the nearest of the names, ignoring case; the first one of equally near names. Returns
// none if for each name more than a third of its letters, and more than one letter, would have to
// change.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word,
                                                      std::span<const std::string> names);

// Returns "; did you mean 'volume'?", or an empty text if no name is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace stormcellar
