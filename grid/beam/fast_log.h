// grid/beam/fast_log.h -- a logarithm and an exponential that compilers can vectorize.
//
// Accuracy  Enforced by tests/grid/fast_log_test.cpp. fast_log2: 4e-7 + 1e-7 |log2 x| for all
//           normal floats; for a double, it is std::log2. fast_exp2: 3e-7 of its value, for x from
//           -126 to 127.
// Threads   Pure functions, with the same bits on every machine.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace stormcellar::grid {

// Returns log2 x for a positive, normal x. Writes x as m 2^e with m in [2/3, 4/3). Then log2 m = 2
// atanh(s) / ln 2, where s = (m - 1) / (m + 1) and |s| <= 1/5. The series of atanh is cut after
// s^9.
[[nodiscard]] inline float fast_log2(float x) noexcept {
    constexpr std::uint32_t two_thirds = 0x3F2AAAAB;
    const auto bits = std::bit_cast<std::uint32_t>(x);
    const std::int32_t exponent = static_cast<std::int32_t>(bits - two_thirds) >> 23;
    const float m = std::bit_cast<float>(bits - (static_cast<std::uint32_t>(exponent) << 23));
    const float s = (m - 1) / (m + 1);
    const float s2 = s * s;
    constexpr float scale = 2.88539008F;  // 2 / ln 2
    const float series = 1 + s2 * (1.0F / 3 + s2 * (1.0F / 5 + s2 * (1.0F / 7 + s2 * (1.0F / 9))));
    return static_cast<float>(exponent) + scale * s * series;
}
[[nodiscard]] inline double fast_log2(double x) noexcept {
    return std::log2(x);
}

// Returns 2^x for x from -126 to 127. Writes x as n + t, where n is whole and |t| <= 1/2. 2^t is
// the series of exp(t ln 2).
[[nodiscard]] inline float fast_exp2(float x) noexcept {
    constexpr float no_fraction = 0x1.8p23F;
    const float whole = x + no_fraction - no_fraction;
    const float t = (x - whole) * 0.693147181F;
    const float series =
        1 + t * (1 + t * (1.0F / 2 +
                          t * (1.0F / 6 + t * (1.0F / 24 + t * (1.0F / 120 + t * (1.0F / 720))))));
    const auto exponent = static_cast<std::int32_t>(whole) + 127;
    return series * std::bit_cast<float>(static_cast<std::uint32_t>(exponent) << 23);
}

}  // namespace stormcellar::grid
