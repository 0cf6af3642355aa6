// base/degree.h -- one degree in radians, as a factor: std::sin(30 * degree).
#pragma once

#include <numbers>

namespace stormcellar {

inline constexpr double degree = std::numbers::pi / 180;

}  // namespace stormcellar
