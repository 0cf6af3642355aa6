// base/floating_point.h -- arithmetic for programs that enable floating-point traps.
//
// A program may enable traps on invalid operations, division by zero and overflow (feenableexcept,
// glibc). Our libraries never divide by zero or compare NaN on purpose, so such a program works as
// usual. is_within() tests a number that may be NaN. MaskedTraps disables the traps during a call
// that may overflow or divide by zero, for example a call of GeographicLib.
//
// Threads   Traps belong to a thread.
#pragma once

#include <cfenv>
#include <cmath>

namespace stormcellar {

// Returns true if the value is from `least` to `greatest`, and false if one of the three is NaN.
// Comparing a quiet NaN with < or >= is an invalid operation, but passing it here is not.
template <class Real>
[[nodiscard]] bool is_within(Real value, Real least, Real greatest) noexcept {
    return std::isgreaterequal(value, least) && std::islessequal(value, greatest);
}

// Disables the traps of the thread while the object lives. The destructor clears the flags of
// exceptions and enables the same traps again. If no traps were enabled, the destructor does
// nothing, so the flags stay.
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
