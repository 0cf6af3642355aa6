#include "accuracy/timing.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace stormcellar::accuracy {
namespace {

Timing summarize_runs(const std::vector<double>& runs) {
    Timing timing{.first_s = runs.front()};
    std::vector<double> later(runs.begin() + (runs.size() > 1 ? 1 : 0), runs.end());
    std::sort(later.begin(), later.end());
    timing.least_s = later.front();
    const std::size_t middle = later.size() / 2;
    timing.median_s =
        later.size() % 2 == 1 ? later[middle] : (later[middle - 1] + later[middle]) / 2;
    return timing;
}

}  // namespace

double monotonic_s() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

double thread_s() {
    std::timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<Timing> time_in_rounds(std::span<const std::function<void()>> works, int rounds,
                                   const std::function<double()>& now_s) {
    std::vector<std::vector<double>> runs(works.size());
    for (int round = 0; round < std::max(1, rounds); ++round) {
        for (std::size_t i = 0; i < works.size(); ++i) {
            const std::size_t which = round % 2 == 0 ? i : works.size() - 1 - i;
            const double start_s = now_s();
            works[which]();
            runs[which].push_back(now_s() - start_s);
        }
    }
    std::vector<Timing> timings;
    std::transform(runs.begin(), runs.end(), std::back_inserter(timings), summarize_runs);
    return timings;
}

}  // namespace stormcellar::accuracy
