#include "daemon/config/loopback_host.h"

#include <algorithm>
#include <array>

#include <strings.h>

namespace stormcellar::daemon {
namespace {

constexpr std::array<std::string_view, 3> names = {"127.0.0.1", "localhost", "[::1]"};

bool begins_with(std::string_view text, std::string_view name) noexcept {
    return text.size() >= name.size() && ::strncasecmp(text.data(), name.data(), name.size()) == 0;
}

bool is_port(std::string_view text) noexcept {
    return !text.empty() && text.size() <= 5 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool is_loopback_host(std::string_view host) noexcept {
    for (const std::string_view name : names) {
        if (!begins_with(host, name)) continue;
        const std::string_view rest = host.substr(name.size());
        if (rest.empty() || (rest.front() == ':' && is_port(rest.substr(1)))) return true;
    }
    return false;
}

}  // namespace stormcellar::daemon
