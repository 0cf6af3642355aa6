#include "base/host_field.h"

#include <algorithm>
#include <array>

#include <strings.h>

namespace stormcellar {
namespace {

bool is_port_number(std::string_view text) noexcept {
    return !text.empty() && text.size() <= 5 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string_view name_in_host_field(std::string_view host) noexcept {
    const bool is_v6 = host.starts_with('[');
    const std::size_t end = is_v6 ? host.find(']') : host.find(':');
    if (end == std::string_view::npos) return is_v6 ? std::string_view{} : host;
    const std::string_view name = host.substr(0, is_v6 ? end + 1 : end);
    const std::string_view rest = host.substr(name.size());
    if (rest.empty() || (rest.front() == ':' && is_port_number(rest.substr(1)))) return name;
    return {};
}

bool is_loopback_host(std::string_view host) noexcept {
    constexpr std::array<std::string_view, 3> loopback_names = {"127.0.0.1", "localhost", "[::1]"};
    const std::string_view name = name_in_host_field(host);
    return std::ranges::any_of(loopback_names, [&](std::string_view one) {
        return one.size() == name.size() &&
               ::strncasecmp(one.data(), name.data(), name.size()) == 0;
    });
}

}  // namespace stormcellar
