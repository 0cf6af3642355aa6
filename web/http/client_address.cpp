#include "web/http/client_address.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace stormcellar::web {
namespace {

constexpr std::size_t network_bytes = 8;

std::optional<in6_addr> v6_of(const std::string& text) {
    in6_addr address{};
    if (::inet_pton(AF_INET6, text.c_str(), &address) != 1) return std::nullopt;
    return address;
}

std::string text_of_v6(const in6_addr& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    ::inet_ntop(AF_INET6, &address, text.data(), text.size());
    return text.data();
}

// Returns the part before the port.
std::string_view host_of(std::string_view text) {
    if (text.starts_with('[')) {
        const std::size_t end = text.find(']');
        return end == text.npos ? std::string_view{} : text.substr(1, end - 1);
    }
    const std::size_t colon = text.find(':');
    const bool has_port = colon != text.npos && text.find(':', colon + 1) == text.npos;
    return has_port ? text.substr(0, colon) : text;
}

}  // namespace

std::optional<std::string> read_address(std::string_view text) {
    const std::string host(host_of(text));
    in_addr v4{};
    if (::inet_pton(AF_INET, host.c_str(), &v4) == 1) return host;
    const auto v6 = v6_of(host);
    if (!v6) return std::nullopt;
    std::string plain = text_of_v6(*v6);
    if (IN6_IS_ADDR_V4MAPPED(&*v6)) plain.erase(0, plain.rfind(':') + 1);
    return plain;
}

std::string client_network(const std::string& address) {
    if (address.find(':') == std::string::npos) return address;
    auto v6 = v6_of(address);
    if (!v6) return address;
    std::fill(std::begin(v6->s6_addr) + network_bytes, std::end(v6->s6_addr), std::uint8_t{0});
    return text_of_v6(*v6) + "/64";
}

}  // namespace stormcellar::web
