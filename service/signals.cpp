#include "service/signals.h"

#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace stormcellar {

Result<Signals> Signals::open() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP})
        sigaddset(&set, signal);
    std::signal(SIGPIPE, SIG_IGN);
    if (::pthread_sigmask(SIG_BLOCK, &set, nullptr) != 0) {
        return fail(ErrorCode::internal, "cannot block signals");
    }
    Descriptor descriptor(::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
    if (!descriptor.is_open()) {
        return fail(ErrorCode::io, "signalfd: {}", std::system_category().message(errno));
    }
    return Signals(std::move(descriptor));
}

std::optional<int> Signals::next(std::chrono::milliseconds most) const {
    pollfd source{descriptor(), POLLIN, 0};
    if (most.count() > 0) (void)::poll(&source, 1, static_cast<int>(most.count()));
    signalfd_siginfo facts{};
    if (::read(descriptor(), &facts, sizeof facts) != ssize_t{sizeof facts}) return std::nullopt;
    return static_cast<int>(facts.ssi_signo);
}

BlockedSignals::BlockedSignals(std::span<const int> numbers) {
    sigset_t set;
    ::sigemptyset(&set);
    for (const int number : numbers)
        ::sigaddset(&set, number);
    ::pthread_sigmask(SIG_BLOCK, &set, &before_);
}

std::string_view name_of_ending(int signal) {
    return signal == SIGTERM ? "SIGTERM" : "SIGINT";
}

}  // namespace stormcellar
