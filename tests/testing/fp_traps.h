// tests/testing/fp_traps.h -- tests that stop where floating-point arithmetic goes wrong.
//
// With STORMCELLAR_FP_TRAPS=1 in the environment, each test body of every test program runs with
// traps on: an invalid operation (0/0, a NaN in an ordering comparison, infinity to integer), a
// division by zero or an overflow ends the program with SIGFPE, and what happened is printed.
// Underflow and inexact results are ordinary. A library must not rely on NaN or infinity to flow
// through comparisons unseen; what is masked is said in base/floating_point.h.
// Threads  traps belong to a thread; one that is started inherits those of its starter (glibc), so
//          workers have them too (tests/hard_cases/fp_traps_test.cpp).
#pragma once

namespace stormcellar::testing {

// The traps of this thread are on while it lives, and then as before. base/floating_point.h has
// MaskedTraps for the opposite.
class FpTraps {
  public:
    FpTraps();
    ~FpTraps();
    FpTraps(const FpTraps&) = delete;
    FpTraps& operator=(const FpTraps&) = delete;

  private:
    int before_;
};

// Whether the traps of this thread are on.
[[nodiscard]] bool fp_traps_are_on();

}  // namespace stormcellar::testing
