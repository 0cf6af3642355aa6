#include "grid/beam/fast_log.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

TEST(FastLog, IsAsAccurateAsStated) {
    for (double exponent = -125.99; exponent < 127.9; exponent += 0.00071) {
        const auto x = static_cast<float>(std::exp2(exponent));
        const double exact = std::log2(static_cast<double>(x));
        ASSERT_NEAR(static_cast<double>(fast_log2(x)), exact, 4e-7 + 1e-7 * std::abs(exact)) << x;
    }
    EXPECT_EQ(fast_log2(1.0F), 0);
    EXPECT_EQ(fast_log2(0x1p-126F), -126);
}

TEST(FastExp, IsAsAccurateAsStated) {
    for (double exponent = -126; exponent < 127; exponent += 0.00057) {
        const auto x = static_cast<float>(exponent);
        const double exact = std::exp2(static_cast<double>(x));
        ASSERT_NEAR(static_cast<double>(fast_exp2(x)), exact, 3e-7 * exact) << x;
    }
    EXPECT_EQ(fast_exp2(0), 1);
    EXPECT_EQ(fast_exp2(-126), 0x1p-126F);
}

}  // namespace
}  // namespace stormcellar::grid
