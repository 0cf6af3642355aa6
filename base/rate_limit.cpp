#include "base/rate_limit.h"

namespace stormcellar {

bool RateLimit::allow(SteadyTime now) {
    if (now - began_ >= period_ && held_back_ == 0) {
        began_ = now;
        used_ = 0;
    }
    if (used_ < most_) {
        ++used_;
        return true;
    }
    ++held_back_;
    return false;
}

std::optional<std::uint64_t> RateLimit::take_held_back(SteadyTime now) {
    if (held_back_ == 0 || now - began_ < period_) return std::nullopt;
    const std::uint64_t count = held_back_;
    held_back_ = 0;
    return count;
}

}  // namespace stormcellar
