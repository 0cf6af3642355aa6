// level2/decode/problem_notes.h -- turns the problems in a report into notes for the file that is
// made from the decoded volume.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// Returns the texts of the first 20 listed problems. If more are listed, adds a text with their
// number.
[[nodiscard]] std::vector<std::string> notes_of(const DecodeReport& report);

}  // namespace stormcellar::level2
