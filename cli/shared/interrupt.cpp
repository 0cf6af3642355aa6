#include "cli/shared/interrupt.h"

#include <array>
#include <cstddef>

#include <signal.h>

namespace stormcellar::cli {
namespace {

std::atomic<bool> came{false};
std::atomic<int> which{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may not wait for a lock");

constexpr std::array watched{SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, watched.size()> actions_before{};

// Sets the flag, and restores the previous handler, so that a second signal ends the program.
void note_signal(int number) {
    for (std::size_t i = 0; i < watched.size(); ++i) {
        if (watched[i] == number) ::sigaction(number, &actions_before[i], nullptr);
    }
    which = number;
    came = true;
}

}  // namespace

Interrupt::Interrupt() {
    came = false;
    which = 0;
    for (std::size_t i = 0; i < watched.size(); ++i) {
        ::sigaction(watched[i], nullptr, &actions_before[i]);
        if (actions_before[i].sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = note_signal;
        action.sa_flags = SA_RESTART;
        ::sigaction(watched[i], &action, nullptr);
    }
}

Interrupt::~Interrupt() {
    restore();
}

const std::atomic<bool>& Interrupt::flag() const {
    return came;
}

void Interrupt::end_by_signal() {
    restore();
    if (came) ::raise(which);
}

void Interrupt::restore() {
    for (std::size_t i = 0; i < watched.size(); ++i) {
        ::sigaction(watched[i], &actions_before[i], nullptr);
    }
}

}  // namespace stormcellar::cli
