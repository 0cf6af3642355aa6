#include "daemon/process/wake_up.h"

#include <cerrno>
#include <cstdint>
#include <system_error>

#include <sys/eventfd.h>
#include <unistd.h>

namespace stormcellar::daemon {

WakeUp::WakeUp() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (!descriptor_.is_open()) throw std::system_error(errno, std::system_category(), "eventfd");
}

// These calls fail only if the counter is full (the event is set) or empty (the event is clear).
void WakeUp::set() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(descriptor(), &one, sizeof one);
}

void WakeUp::clear() {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(descriptor(), &count, sizeof count);
}

}  // namespace stormcellar::daemon
