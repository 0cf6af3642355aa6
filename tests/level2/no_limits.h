// tests/level2/no_limits.h -- gives tests an ample limit and a selection of everything.
#pragma once

#include <cstdint>

#include "stormcellar/level2/selection.h"

namespace stormcellar::level2 {

inline constexpr std::uint64_t ample = std::uint64_t{1} << 30;
inline const Selection everything;

}  // namespace stormcellar::level2
