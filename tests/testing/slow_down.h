// tests/testing/slow_down.h -- how much less a test may do where everything takes far longer.
#pragma once

namespace stormcellar::testing {

#if defined(STORMCELLAR_SANITIZED)
inline constexpr int slow_down = 8;
#else
inline constexpr int slow_down = 1;
#endif

}  // namespace stormcellar::testing
