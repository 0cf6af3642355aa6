// tests/accuracy/infinity.h -- what no budget allows.
#pragma once

#include <limits>

namespace stormcellar::accuracy {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace stormcellar::accuracy
