// tests/testing/slow_down.h -- how much less a test may do where everything takes far longer.
#pragma once

namespace stormcellar::testing {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int slow_down = 8;
#else
inline constexpr int slow_down = 1;
#endif

}  // namespace stormcellar::testing
