// base/counted.h -- writes counted things, such as "2 files", for sentences.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns "1 file", "0 files" or "2 directories". Give the plural as `things` unless it is `thing`
// with an s.
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view thing,
                                  std::string_view things = {});

}  // namespace stormcellar
