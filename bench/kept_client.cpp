#include "bench/kept_client.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "bench/measure.h"

namespace stormcellar::bench {
namespace {

using AnswerClock = std::chrono::steady_clock;

// The value of a header, by its name in small letters; "" if there is none.
std::string header_in(const std::string& head, std::string_view name) {
    std::string small = head;
    std::ranges::transform(small, small.begin(),
                           [](unsigned char letter) { return std::tolower(letter); });
    const std::string sought = fmt::format("\r\n{}:", name);
    const std::size_t at = small.find(sought);
    if (at == std::string::npos) return {};
    const std::size_t begin = small.find_first_not_of(' ', at + sought.size());
    return small.substr(begin, small.find("\r\n", begin) - begin);
}

}  // namespace

Status KeptClient::connect() {
    socket_ = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int at_once = 1;
    (void)::setsockopt(socket_.number(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    if (::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) !=
        0)
        return fail(ErrorCode::io, "no connection to port {}", port_);
    unread_.clear();
    ++connections_;
    return {};
}

Status KeptClient::read_more() {
    std::array<char, 65536> buffer{};
    const ssize_t count = ::recv(socket_.number(), buffer.data(), buffer.size(), 0);
    if (count <= 0) return fail(ErrorCode::io, "the server closed a connection within an answer");
    unread_.append(buffer.data(), static_cast<std::size_t>(count));
    return {};
}

Result<std::string> KeptClient::read_head() {
    std::size_t end = 0;
    while ((end = unread_.find("\r\n\r\n")) == std::string::npos) {
        if (Status more = read_more(); !more) return pass_on(more);
    }
    std::string head = unread_.substr(0, end + 2);
    unread_.erase(0, end + 4);
    return head;
}

Status KeptClient::read_body(const std::string& head, std::string& body) {
    const long size = number_in(header_in(head, "content-length"));
    if (size < 0) return fail(ErrorCode::internal, "an answer has no Content-Length");
    const auto wanted = static_cast<std::size_t>(size);
    while (unread_.size() < wanted) {
        if (Status more = read_more(); !more) return more;
    }
    body = unread_.substr(0, wanted);
    unread_.erase(0, wanted);
    return {};
}

Result<TimedAnswer> KeptClient::get(const std::string& path) {
    const std::string request =
        fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", path, port_);
    const auto begin = AnswerClock::now();
    if (!socket_.is_open()) {
        if (Status connected = connect(); !connected) return pass_on(connected);
    }
    if (::send(socket_.number(), request.data(), request.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request.size()))
        return fail(ErrorCode::io, "a request could not be sent");
    const auto head = read_head();
    if (!head) return pass_on(head);
    TimedAnswer answer;
    if (Status read = read_body(*head, answer.body); !read) return pass_on(read);
    answer.ms = std::chrono::duration<double, std::milli>(AnswerClock::now() - begin).count();
    if (std::sscanf(head->c_str(), "HTTP/1.1 %d", &answer.status) != 1)
        return fail(ErrorCode::internal, "an answer has no status");
    if (header_in(*head, "connection") == "close") socket_ = Descriptor();
    return answer;
}

}  // namespace stormcellar::bench
