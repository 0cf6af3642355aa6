// base/floating_point.h -- arithmetic for programs that enable floating-point traps.
//
// A program may enable traps on invalid operations, division by zero and overflow (feenableexcept,
// glibc). The rooms never divide by zero or compare NaN on purpose, so such a program works as
// usual. A number that may be NaN is tested with is_within(), and other libraries, which do not
// care about traps, are called under MaskedTraps.
//
// Threads   Traps belong to a thread.
#pragma once

#include <cfenv>
#include <cmath>

namespace stormcellar {

// Returns true if the value is in the range, and false for NaN. Unlike an ordinary comparison with
// NaN, this is not an invalid operation.
template <class Real>
[[nodiscard]] bool is_within(Real value, Real least, Real greatest) noexcept {
    return std::isgreaterequal(value, least) && std::islessequal(value, greatest);
}

// Disables the traps of this thread while it lives, and then clears the flags of exceptions. If no
// traps are enabled, it does nothing, which costs one instruction.
class MaskedTraps {
  public:
    MaskedTraps() noexcept : traps_(fegetexcept()) {
        if (traps_ != 0) fedisableexcept(FE_ALL_EXCEPT);
    }
    ~MaskedTraps() {
        if (traps_ == 0) return;
        std::feclearexcept(FE_ALL_EXCEPT);
        feenableexcept(traps_);
    }
    MaskedTraps(const MaskedTraps&) = delete;
    MaskedTraps& operator=(const MaskedTraps&) = delete;

  private:
    int traps_;
};

}  // namespace stormcellar
