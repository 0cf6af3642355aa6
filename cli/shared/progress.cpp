#include "cli/shared/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace stormcellar::cli {

std::string progress_line(const std::string& what, std::size_t done, std::size_t total) {
    constexpr std::size_t width = 40;
    const std::size_t filled = total == 0 ? width : std::min(width, done * width / total);
    return fmt::format("{} [{}{}] {:>{}}/{}", what, std::string(filled, '#'),
                       std::string(width - filled, '.'), done, std::to_string(total).size(), total);
}

Progress::Progress(std::string what, std::size_t total, bool wanted)
    : what_(std::move(what)), total_(total), shown_(wanted && ::isatty(STDERR_FILENO) == 1) {
    show(0);
}

Progress::~Progress() {
    clear();
}

void Progress::show(std::size_t done) {
    if (!shown_) return;
    fmt::print(stderr, "\r{}", progress_line(what_, done, total_));
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
