#include "cli/shared/interrupt.h"

namespace stormcellar::cli {
namespace {

std::atomic<bool> came{false};
std::atomic<int> which{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may not wait for a lock");

// SA_RESETHAND restores the usual effect of the signal, so that a second one ends the program.
void note_signal(int number) {
    which = number;
    came = true;
}

}  // namespace

Interrupt::Interrupt() {
    came = false;
    which = 0;
    for (std::size_t i = 0; i < watched.size(); ++i) {
        ::sigaction(watched[i], nullptr, &before_[i]);
        if (before_[i].sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = note_signal;
        action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
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
        ::sigaction(watched[i], &before_[i], nullptr);
    }
}

}  // namespace stormcellar::cli
