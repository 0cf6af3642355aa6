#include "bench/grid_watch.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

namespace stormcellar::bench {

namespace fs = std::filesystem;

GridWatch::~GridWatch() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Status GridWatch::watch(const fs::path& cache, std::span<const std::string> stations,
                        std::span<const std::string> days, level2::Moment moment) {
    descriptor_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    for (const std::string& station : stations) {
        for (const std::string& day : days) {
            const fs::path directory = cache / station / level2::moment_name(moment) / day;
            std::error_code problem;
            fs::create_directories(directory, problem);
            if (::inotify_add_watch(descriptor_, directory.c_str(), IN_MOVED_TO) < 0) {
                return fail(ErrorCode::io, "{}: {}", directory.native(),
                            std::system_category().message(errno));
            }
        }
    }
    return {};
}

void GridWatch::read(const std::function<void(std::string_view)>& appeared) const {
    alignas(inotify_event) std::array<char, 16'384> buffer{};
    for (;;) {
        const ssize_t length = ::read(descriptor_, buffer.data(), buffer.size());
        if (length <= 0) return;
        for (std::size_t at = 0; at < static_cast<std::size_t>(length);) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            if (event.len > 0) appeared(buffer.data() + at + sizeof event);
            at += sizeof event + event.len;
        }
    }
}

void GridWatch::wait(double seconds) const {
    pollfd waiting{descriptor_, POLLIN, 0};
    ::poll(&waiting, 1, static_cast<int>(seconds * 1000) + 1);
}

}  // namespace stormcellar::bench
