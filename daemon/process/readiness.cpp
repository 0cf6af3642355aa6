#include "daemon/process/readiness.h"

#include <algorithm>

#include <unistd.h>

namespace stormcellar::daemon {

Status can_write_in(FileSystem& files, const std::filesystem::path& directory) {
    const std::filesystem::path probe =
        directory / fmt::format(".stormcellar-tmp-ready-{}", ::getpid());
    (void)files.remove(probe);  // a killed process with the same number may have left it
    const Result<int> made = files.create_exclusive(probe);
    if (!made) return pass_on(made);
    files.close(*made);
    return files.remove(probe);
}

std::optional<SteadyTime> Readiness::next_time() const {
    if (is_ready_) return std::nullopt;
    return next_look_;
}

bool Readiness::look(SteadyTime now) {
    if (is_ready_ || now < next_look_) return false;
    next_look_ = now + wait_;
    wait_ = std::min(2 * wait_, longest_wait);
    for (const Check& check : checks_) {
        const Status there = check();
        if (there) continue;
        missing_ = there.error().message;
        return true;
    }
    missing_.clear();
    is_ready_ = true;
    return true;
}

bool Readiness::is_news() {
    if (wait_ < longest_wait || missing_ == said_) return false;
    said_ = missing_;
    return true;
}

}  // namespace stormcellar::daemon
