#include "tests/daemon/status_client.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/testing/loopback.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

constexpr int longest_wait_ms = 20'000;

template <class Address>
Descriptor connect_to(int family, const Address& address) {
    Descriptor socket;
    const bool is_connected = testing::eventually([&] {
        socket = Descriptor(::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0));
        return ::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address),
                         sizeof address) == 0;
    });
    return is_connected ? std::move(socket) : Descriptor{};
}

}  // namespace

StatusClient StatusClient::at_path(const std::filesystem::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(static_cast<char*>(address.sun_path), path.c_str(), sizeof address.sun_path - 1);
    return StatusClient(connect_to(AF_UNIX, address));
}

StatusClient StatusClient::at_port(int port) {
    return StatusClient(connect_to(AF_INET, testing::loopback_address(port)));
}

bool StatusClient::send(const std::string& text) const {
    std::size_t sent = 0;
    while (sent < text.size()) {
        const ssize_t step_bytes =
            ::send(socket_.number(), text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (step_bytes <= 0) return false;
        sent += static_cast<std::size_t>(step_bytes);
    }
    return true;
}

std::optional<std::string> StatusClient::read_to_end() const {
    std::string all;
    std::array<char, 65536> buffer{};
    while (true) {
        pollfd source{socket_.number(), POLLIN, 0};
        if (::poll(&source, 1, longest_wait_ms) <= 0) return std::nullopt;
        const ssize_t got = ::read(socket_.number(), buffer.data(), buffer.size());
        if (got <= 0) return all;  // the end, or the connection was reset
        all.append(buffer.data(), static_cast<std::size_t>(got));
    }
}

bool StatusClient::is_cut_off() const {
    pollfd source{socket_.number(), 0, 0};
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
