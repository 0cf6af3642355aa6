#include "cache/map_guard.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include <sys/mman.h>

#include "cache/map_registry.h"

namespace stormcellar::cache {
namespace {

// The action for SIGBUS before the guard was installed; set once, before the handler can run.
struct sigaction former_action = {};

// Replaces the contents of the registered map at the address by zeros. Returns false if there is no
// such map or replacing fails.
bool take_fault(void* address) {
    const auto place = reinterpret_cast<std::uintptr_t>(address);
    const auto range = cut_map_at(place);
    if (!range) return false;
    std::byte* const start = static_cast<std::byte*>(address) - (place - range->begin);
    return ::mmap(start, range->end - range->begin, PROT_READ,
                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0) != MAP_FAILED;
}

// Makes the signal end the program as it would without a handler. Restores the default action; then
// a fault happens again by itself, and a signal that was sent is sent again.
void end_by_signal(int signal, bool sent) {
    struct sigaction standard = {};
    standard.sa_handler = SIG_DFL;
    ::sigaction(signal, &standard, nullptr);
    if (sent) ::raise(signal);
}

void pass_to_former(int signal, siginfo_t* info, void* context, bool sent) {
    if ((former_action.sa_flags & SA_SIGINFO) != 0) {
        former_action.sa_sigaction(signal, info, context);
    } else if (former_action.sa_handler == SIG_IGN && sent) {
        return;
    } else if (former_action.sa_handler == SIG_DFL || former_action.sa_handler == SIG_IGN) {
        end_by_signal(signal, sent);
    } else {
        former_action.sa_handler(signal);
    }
}

void on_bus_error(int signal, siginfo_t* info, void* context) {
    const int error_number = errno;
    const bool sent = info->si_code <= 0;  // by kill(), so there is no address
    if (sent || !take_fault(info->si_addr)) pass_to_former(signal, info, context, sent);
    errno = error_number;
}

}  // namespace

void install_map_guard() {
    static std::once_flag once;
    std::call_once(once, [] {
        ::sigaction(SIGBUS, nullptr, &former_action);
        struct sigaction action = {};
        action.sa_sigaction = on_bus_error;
        action.sa_flags = SA_SIGINFO | SA_ONSTACK;
        sigemptyset(&action.sa_mask);
        ::sigaction(SIGBUS, &action, nullptr);
    });
}

}  // namespace stormcellar::cache
