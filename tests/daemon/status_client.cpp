#include "tests/daemon/status_client.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <utility>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

constexpr int longest_wait_ms = 20'000;

template <class Address>
int connect_to(int family, const Address& address) {
    int descriptor = -1;
    const bool is_connected = testing::eventually([&] {
        descriptor = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
            return true;
        ::close(descriptor);
        return false;
    });
    return is_connected ? descriptor : -1;
}

}  // namespace

StatusClient StatusClient::at_path(const std::filesystem::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(static_cast<char*>(address.sun_path), path.c_str(), sizeof address.sun_path - 1);
    return StatusClient(connect_to(AF_UNIX, address));
}

StatusClient StatusClient::at_port(bool ipv6, int port) {
    if (ipv6) {
        sockaddr_in6 address{};
        address.sin6_family = AF_INET6;
        address.sin6_port = htons(static_cast<std::uint16_t>(port));
        address.sin6_addr = IN6ADDR_LOOPBACK_INIT;
        return StatusClient(connect_to(AF_INET6, address));
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return StatusClient(connect_to(AF_INET, address));
}

StatusClient::StatusClient(StatusClient&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

StatusClient::~StatusClient() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

bool StatusClient::send(const std::string& text) const {
    std::size_t sent = 0;
    while (sent < text.size()) {
        const ssize_t step_bytes =
            ::send(descriptor_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (step_bytes <= 0) return false;
        sent += static_cast<std::size_t>(step_bytes);
    }
    return true;
}

std::optional<std::string> StatusClient::read_to_end() const {
    std::string all;
    std::array<char, 65536> buffer{};
    while (true) {
        pollfd source{descriptor_, POLLIN, 0};
        if (::poll(&source, 1, longest_wait_ms) <= 0) return std::nullopt;
        const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
        if (got <= 0) return all;  // also if the connection was reset
        all.append(buffer.data(), static_cast<std::size_t>(got));
    }
}

bool StatusClient::is_cut_off() const {
    pollfd source{descriptor_, 0, 0};
    return ::poll(&source, 1, 0) == 1 && (source.revents & (POLLHUP | POLLERR)) != 0;
}

std::string StatusClient::ask(const std::string& request) const {
    send(request);
    return read_to_end().value_or("");
}

std::string get(const std::string& path) {
    return "GET " + path + " HTTP/1.0\r\n\r\n";
}

std::string body_of(const std::string& answer) {
    const auto end = answer.find("\r\n\r\n");
    return end == std::string::npos ? "" : answer.substr(end + 4);
}

}  // namespace stormcellar::daemon
