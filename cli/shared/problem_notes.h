// cli/shared/problem_notes.h -- a decoder's problems as notes for a file made from what it decoded.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {

// The messages of the first 20, and how many more there are.
[[nodiscard]] std::vector<std::string> notes_of(const level2::DecodeReport& report);

}  // namespace stormcellar::cli
