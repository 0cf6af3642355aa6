// level2/decode/problem_notes.h -- turns the problems that a decoder reports into notes for the
// file made from its result.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// Returns the messages of the first 20 problems, and how many more there are.
[[nodiscard]] std::vector<std::string> notes_of(const DecodeReport& report);

}  // namespace stormcellar::level2
