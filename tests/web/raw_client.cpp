#include "tests/web/raw_client.h"

#include <array>
#include <cstdlib>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace stormcellar::web {

RawClient::RawClient(int port, int receive_buffer, const std::string& from)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer > 0)
        ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUF, &receive_buffer,
                     sizeof receive_buffer);
    if (!from.empty()) {
        sockaddr_in own{};
        own.sin_family = AF_INET;
        ::inet_pton(AF_INET, from.c_str(), &own.sin_addr);
        static_cast<void>(
            ::bind(socket_.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own));
    }
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
        socket_ = Descriptor{};
}

bool RawClient::send(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

std::optional<std::string> RawClient::read_some(std::chrono::milliseconds patience) {
    pollfd one{socket_.number(), POLLIN, 0};
    if (::poll(&one, 1, static_cast<int>(patience.count())) <= 0) return std::string{};
    std::array<char, 65536> buffer{};
    const ssize_t count = ::recv(socket_.number(), buffer.data(), buffer.size(), 0);
    if (count <= 0) {
        has_ended_ = true;
        return std::nullopt;
    }
    return std::string(buffer.data(), static_cast<std::size_t>(count));
}

std::string RawClient::read_to_end(std::chrono::milliseconds patience) {
    std::string all;
    while (const auto some = read_some(patience)) {
        if (some->empty()) break;
        all += *some;
    }
    return all;
}

std::string RawClient::read_until(std::string_view text, std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    std::string all;
    while (all.find(text) == std::string::npos && std::chrono::steady_clock::now() < until) {
        const auto some = read_some(std::chrono::milliseconds{100});
        if (!some) break;
        all += *some;
    }
    return all;
}

bool RawClient::is_closed(std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (!has_ended_ && std::chrono::steady_clock::now() < until)
        (void)read_some(std::chrono::milliseconds{50});
    return has_ended_;
}

std::string RawClient::get(int port, std::string_view target, std::string_view more_headers) {
    RawClient client(port);
    std::string request = "GET ";
    request += target;
    request += " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n";
    request += more_headers;
    request += "\r\n";
    client.send(request);
    return client.read_to_end();
}

int status_in(std::string_view answer) {
    if (!answer.starts_with("HTTP/1.") || answer.size() < 12) return 0;
    return std::atoi(std::string(answer.substr(9, 3)).c_str());
}

std::string body_in(std::string_view answer) {
    const std::size_t end = answer.find("\r\n\r\n");
    return end == std::string_view::npos ? std::string{} : std::string(answer.substr(end + 4));
}

}  // namespace stormcellar::web
