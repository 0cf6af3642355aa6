// base/floating_point.h -- arithmetic that keeps quiet where a program has floating-point traps on.
//
// A program may run with traps on invalid operations, division by zero and overflow
// (feenableexcept, glibc). The rooms neither divide by zero nor compare NaN in earnest, so such a
// program works as ever; what a caller may hand in as NaN is asked with is_within(), and other
// libraries, which mind no traps, are called with MaskedTraps about.
// Threads  traps belong to a thread.
#pragma once

#include <cfenv>
#include <cmath>

namespace stormcellar {

// False for NaN. An ordinary comparison with NaN is an invalid operation; this is none.
template <class Real>
[[nodiscard]] bool is_within(Real value, Real least, Real greatest) noexcept {
    return std::isgreaterequal(value, least) && std::islessequal(value, greatest);
}

// The traps of this thread are off while it lives; what was raised meanwhile is forgotten. Where
// none are on it costs one instruction to see that.
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
