#include "cli/shared/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace stormcellar::cli {

namespace {

constexpr std::size_t bar_width = 24;
constexpr double soonest_s = 1;  // earlier estimates would only flicker

std::string rate_text(double per_second) {
    if (per_second >= 100) return fmt::format("{:.0f} a second", per_second);
    if (per_second >= 1) return fmt::format("{:.1f} a second", per_second);
    if (per_second * 60 >= 1) return fmt::format("{:.1f} a minute", per_second * 60);
    return fmt::format("{:.1f} an hour", per_second * 3600);
}

std::string time_text(double seconds) {
    const auto whole = static_cast<long long>(std::ceil(std::min(seconds, 1e9)));
    if (whole < 100) return fmt::format("{} s", whole);
    const long long minutes = (whole + 59) / 60;
    if (minutes < 100) return fmt::format("{} min", minutes);
    return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace

std::string progress_line(const std::string& what, std::size_t done, std::size_t total,
                          double elapsed_s) {
    const std::size_t filled =
        total == 0 ? bar_width : std::min(bar_width, done * bar_width / total);
    std::string line = fmt::format("{} [{}{}] {:>{}}/{}", what, std::string(filled, '#'),
                                   std::string(bar_width - filled, '.'), done,
                                   std::to_string(total).size(), total);
    if (done == 0 || done >= total || elapsed_s < soonest_s) return line;
    const double per_second = static_cast<double>(done) / elapsed_s;
    return line + fmt::format(", {}, {} left", rate_text(per_second),
                              time_text(static_cast<double>(total - done) / per_second));
}

Progress::Progress(std::string what, std::size_t total, bool wanted)
    : what_(std::move(what)), total_(total), shown_(wanted && ::isatty(STDERR_FILENO) == 1) {
    if (total_ > 0) show(0);
}

Progress::~Progress() {
    clear();
}

void Progress::show(std::size_t done) {
    if (!shown_) return;
    fmt::print(stderr, "\r{}\x1B[K", progress_line(what_, done, total_, seconds_since(start_)));
    std::fflush(stderr);
}

void Progress::show(std::size_t done, std::size_t total) {
    total_ = total;
    show(done);
}

void Progress::clear() {
    if (!shown_) return;
    fmt::print(stderr, "\r\x1B[K");
    std::fflush(stderr);
}

}  // namespace stormcellar::cli
