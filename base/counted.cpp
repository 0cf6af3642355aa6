#include "base/counted.h"

#include <fmt/format.h>

namespace stormcellar {

std::string counted(std::uint64_t count, std::string_view thing, std::string_view things) {
    if (count == 1) return fmt::format("1 {}", thing);
    if (!things.empty()) return fmt::format("{} {}", count, things);
    return fmt::format("{} {}s", count, thing);
}

}  // namespace stormcellar
