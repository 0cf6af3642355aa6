#include "daemon/process/signals.h"

#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include <sys/signalfd.h>
#include <unistd.h>

#include "daemon/log/log.h"

namespace stormcellar::daemon {

Result<Signals> Signals::open() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP})
        sigaddset(&set, signal);
    std::signal(SIGPIPE, SIG_IGN);
    if (::pthread_sigmask(SIG_BLOCK, &set, nullptr) != 0) {
        return fail(ErrorCode::internal, "cannot block signals");
    }
    const int descriptor = ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
    if (descriptor < 0) {
        return fail(ErrorCode::io, "signalfd: {}", std::system_category().message(errno));
    }
    return Signals(descriptor);
}

Signals::Signals(Signals&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Signals::~Signals() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<int> Signals::next() const {
    signalfd_siginfo facts{};
    if (::read(descriptor_, &facts, sizeof facts) != ssize_t{sizeof facts}) return std::nullopt;
    return static_cast<int>(facts.ssi_signo);
}

bool take_signals(const Signals* signals, const std::function<void()>& reload) {
    if (signals == nullptr) return false;
    bool is_asked_to_end = false;
    while (const std::optional<int> signal = signals->next()) {
        if (*signal == SIGHUP) {
            reload();
            continue;
        }
        log_info({Event::stopping}, "stopping: received {}",
                 *signal == SIGTERM ? "SIGTERM" : "SIGINT");
        is_asked_to_end = true;
    }
    return is_asked_to_end;
}

}  // namespace stormcellar::daemon
