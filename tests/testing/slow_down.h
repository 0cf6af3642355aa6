// tests/testing/slow_down.h -- the factor by which tests are slower with a sanitizer.
#pragma once

namespace stormcellar::testing {

#if defined(STORMCELLAR_SANITIZED)
inline constexpr int slow_down = 8;
#else
inline constexpr int slow_down = 1;
#endif

}  // namespace stormcellar::testing
