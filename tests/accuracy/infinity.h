// tests/accuracy/infinity.h -- an error that no budget allows.
#pragma once

#include <limits>

namespace stormcellar::accuracy {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace stormcellar::accuracy
