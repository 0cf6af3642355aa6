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

// This write fails only if the counter is full, and then the event is set already. The read below
// fails only if the counter is empty, and then the event is clear.
void WakeUp::set() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(descriptor(), &one, sizeof one);
}

void WakeUp::clear() {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(descriptor(), &count, sizeof count);
}

}  // namespace stormcellar::daemon
