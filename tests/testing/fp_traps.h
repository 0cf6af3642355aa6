// tests/testing/fp_traps.h -- stops tests where floating-point arithmetic goes wrong.
//
// With STORMCELLAR_FP_TRAPS=1 in the environment, each test body of every test program runs with
// traps on: an invalid operation (0/0, a NaN in an ordering comparison, infinity to integer), a
// division by zero or an overflow prints a message and ends the program with SIGFPE. Underflow and
// inexact results are ordinary. A library must not rely on NaN or infinity to pass through
// comparisons unnoticed; base/floating_point.h lists the masked operations.
//
// Threads   Traps belong to a thread. With glibc a new thread inherits the traps of its starter, so
//           workers have them, too (tests/hard_cases/fp_traps_test.cpp).
#pragma once

namespace stormcellar::testing {

// Turns the traps of this thread on while the object exists. MaskedTraps in base/floating_point.h
// turns traps off.
class FpTraps {
  public:
    FpTraps();
    ~FpTraps();
    FpTraps(const FpTraps&) = delete;
    FpTraps& operator=(const FpTraps&) = delete;

  private:
    int before_;
};

// Returns true if the traps of this thread are on.
[[nodiscard]] bool fp_traps_are_on();

}  // namespace stormcellar::testing
