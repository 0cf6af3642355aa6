#include "base/waited_signals.h"

#include <ctime>

namespace stormcellar {

WaitedSignals::WaitedSignals() {
    sigemptyset(&set_);
    for (const int number : {SIGTERM, SIGINT, SIGHUP})
        sigaddset(&set_, number);
    ::signal(SIGPIPE, SIG_IGN);
    ::pthread_sigmask(SIG_BLOCK, &set_, nullptr);
}

std::optional<int> WaitedSignals::next(std::chrono::milliseconds most) const {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(most);
    timespec wait{};
    wait.tv_sec = static_cast<std::time_t>(seconds.count());
    wait.tv_nsec = static_cast<long>((most - seconds).count()) * 1'000'000;
    const int number = ::sigtimedwait(&set_, nullptr, &wait);
    return number > 0 ? std::optional{number} : std::nullopt;
}

}  // namespace stormcellar
