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

// Returns the least number of edits that turn one text into the other, where no part is edited
// twice. An edit inserts, deletes or replaces a byte, or exchanges two neighboring bytes.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the name with the least edit_distance() from the word, ignoring case, and the first such
// name if there are several. A name counts only if its distance is less than its length in bytes,
// and is at most 1 or at most a third of this length. Returns none if no name counts, or if the
// word has more than 80 bytes.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word,
                                                      std::span<const std::string> names);

// Returns "; did you mean 'volume'?", or an empty text if no name is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace stormcellar
