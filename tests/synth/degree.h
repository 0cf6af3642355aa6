// tests/synth/degree.h -- a degree in radians, as a factor.
#pragma once

#include <numbers>

namespace stormcellar::synth {

inline constexpr double degree = std::numbers::pi / 180;

}  // namespace stormcellar::synth
