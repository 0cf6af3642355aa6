// base/counted.h -- numbers of things, as a sentence has them.
// Thread contract: pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace stormcellar {

// "1 file", "0 files", "2 directories" (`things` names what an s alone does not make many).
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view thing,
                                  std::string_view things = {});

}  // namespace stormcellar
