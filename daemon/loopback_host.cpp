#include "daemon/loopback_host.h"

#include <array>
#include <charconv>

#include <strings.h>

namespace stormcellar::daemon {
namespace {

constexpr std::array<std::string_view, 3> names = {"127.0.0.1", "localhost", "[::1]"};

bool begins_with(std::string_view text, std::string_view name) noexcept {
    return text.size() >= name.size() && ::strncasecmp(text.data(), name.data(), name.size()) == 0;
}

bool is_port(std::string_view text, int port) noexcept {
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.begin(), digits.end(), port).ptr;
    return text == std::string_view{digits.begin(), end};
}

}  // namespace

bool is_loopback_host(std::string_view host, int port) noexcept {
    for (const std::string_view name : names) {
        if (!begins_with(host, name)) continue;
        const std::string_view rest = host.substr(name.size());
        if (rest.empty() || (rest.front() == ':' && is_port(rest.substr(1), port))) return true;
    }
    return false;
}

}  // namespace stormcellar::daemon
