// base/counted.h -- writes numbers of things as a sentence has them.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns "1 file", "0 files" or "2 directories". `things` gives a plural that is not made with an
// s.
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view thing,
                                  std::string_view things = {});

}  // namespace stormcellar
