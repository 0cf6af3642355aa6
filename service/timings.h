// service/timings.h -- measures durations of repeated work.
//
// Count and sum cover all values, because the counters of monitoring systems need that. Median,
// 95th percentile and maximum cover only the last `window` values, so memory is bounded.
//
// Threads   Plain data; one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stormcellar {

struct LatencySummary {
    std::size_t count = 0;
    double median = 0, p95 = 0, max = 0;  // in seconds; meaningless if `count` is 0
};
// Returns the summary. Percentiles are by nearest rank: the 95th percentile is the smallest value
// that at least 95 % of the values do not exceed.
[[nodiscard]] LatencySummary summarise(std::vector<double> seconds);

class Timings {
  public:
    explicit Timings(std::size_t window) : window_(window) {}

    void add(double seconds);
    [[nodiscard]] LatencySummary summary() const { return summarise(last_); }
    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] double sum_s() const { return sum_s_; }

  private:
    std::size_t window_;
    std::vector<double> last_;  // ring of the last `window` values
    std::size_t next_ = 0;
    std::uint64_t count_ = 0;
    double sum_s_ = 0;
};

}  // namespace stormcellar
