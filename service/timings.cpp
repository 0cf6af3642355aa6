#include "service/timings.h"

#include <algorithm>
#include <cmath>

namespace stormcellar {

LatencySummary summarise(std::vector<double> seconds) {
    LatencySummary summary;
    summary.count = seconds.size();
    if (seconds.empty()) return summary;
    std::sort(seconds.begin(), seconds.end());
    const auto rank = [&](double share) {
        const double nth = std::ceil(share * static_cast<double>(seconds.size()));
        return seconds[static_cast<std::size_t>(std::max(nth, 1.0)) - 1];
    };
    summary.median = rank(0.5);
    summary.p95 = rank(0.95);
    summary.max = seconds.back();
    return summary;
}

void Timings::add(double seconds) {
    ++count_;
    sum_s_ += seconds;
    if (last_.size() < window_) {
        last_.push_back(seconds);
    } else {
        last_[next_] = seconds;
        next_ = (next_ + 1) % window_;
    }
}

}  // namespace stormcellar
