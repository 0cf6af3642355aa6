#include "tests/fetch/scripted_server.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/testing/waiting.h"

namespace stormcellar::testing {
namespace {

bool send_all(int connection, std::string_view text) {
    while (!text.empty()) {
        const ssize_t sent = ::send(connection, text.data(), text.size(), MSG_NOSIGNAL);
        if (sent <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

std::string read_head(int connection) {
    std::string head;
    char c = 0;
    while (!head.ends_with("\r\n\r\n") && ::recv(connection, &c, 1, 0) == 1)
        head += c;
    return head;
}

std::string read_body(int connection, const std::string& length) {
    std::string body;
    const std::size_t bytes = length.empty() ? 0 : std::stoul(length);
    char c = 0;
    while (body.size() < bytes && ::recv(connection, &c, 1, 0) == 1)
        body += c;
    return body;
}

std::string decoded(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size()) {
            plain += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
            i += 2;
        } else {
            plain += text[i];
        }
    }
    return plain;
}

// Returns the text between `begin` and `end`; empty if there is no `begin`.
std::string_view between(std::string_view text, std::string_view begin, char end) {
    const std::size_t at = text.find(begin);
    if (at == std::string_view::npos) return {};
    text.remove_prefix(at + begin.size());
    return text.substr(0, text.find(end));
}

}  // namespace

std::string Asked::header(std::string_view name) const {
    return std::string(between(head, fmt::format("\r\n{}: ", name), '\r'));
}

std::string Asked::parameter(std::string_view name) const {
    std::string query = path.substr(std::min(path.find('?'), path.size()));
    std::ranges::replace(query, '?', '&');
    return decoded(between(query, fmt::format("&{}=", name), '&'));
}

std::string Asked::key() const {
    return decoded(std::string_view{path}.substr(1, path.find('?') - 1));
}

ScriptedServer::ScriptedServer(std::function<Reply(const Asked&)> answer)
    : answer_(std::move(answer)) {
    if (::listen(listener_.number(), 64) != 0) throw std::runtime_error("no socket for the server");
    thread_ = std::thread([this] { serve(); });
}

ScriptedServer::~ScriptedServer() {
    stop_ = true;
    thread_.join();
    for (Answering& one : answering_)
        one.thread.join();
}

std::string ScriptedServer::url() const {
    return fmt::format("http://127.0.0.1:{}", port_of(listener_));
}

std::vector<Asked> ScriptedServer::asked() const {
    const std::scoped_lock lock(mutex_);
    return asked_;
}

void ScriptedServer::forget_asked() {
    const std::scoped_lock lock(mutex_);
    asked_.clear();
}

void ScriptedServer::serve() {
    while (!stop_) {
        pollfd ready{listener_.number(), POLLIN, 0};
        if (::poll(&ready, 1, 20) != 1) continue;
        const int connection = ::accept(listener_.number(), nullptr, nullptr);
        if (connection < 0) continue;
        join_done();
        Answering& one = answering_.emplace_back();
        one.thread = std::thread([this, &one, connection] {
            most_at_once_ = std::max<std::size_t>(most_at_once_, ++at_once_);
            answer(connection);
            --at_once_;
            ::close(connection);
            one.is_done = true;
        });
    }
}

// Joins the threads that have answered. A test may make thousands of requests, and a thread that is
// not joined keeps its stack.
void ScriptedServer::join_done() {
    answering_.remove_if([](Answering& one) {
        const bool is_done = one.is_done;
        if (is_done) one.thread.join();
        return is_done;
    });
}

void ScriptedServer::answer(int connection) {
    const std::string head = read_head(connection);
    if (head.size() < 5) return;
    const std::size_t space = std::min(head.find(' '), head.size() - 1);
    Asked asked{head.substr(space + 1, head.find(' ', space + 1) - space - 1), head};
    asked.body = read_body(connection, asked.header("Content-Length"));
    {
        const std::scoped_lock lock(mutex_);
        asked_.push_back(asked);
    }
    const Reply reply = answer_(asked);
    const std::string length = reply.way == Reply::Way::endless || reply.status == 304
                                   ? ""
                                   : fmt::format("Content-Length: {}\r\n", reply.body.size());
    send_all(connection, fmt::format("HTTP/1.1 {} Said\r\n{}{}Connection: close\r\n\r\n",
                                     reply.status, length, reply.headers));
    const bool is_half = reply.way == Reply::Way::cut || reply.way == Reply::Way::hangs;
    const std::size_t sent = is_half ? reply.body.size() / 2 : reply.body.size();
    send_all(connection, std::string_view{reply.body}.substr(0, sent));
    while (!stop_ && reply.way == Reply::Way::endless &&
           send_all(connection, std::string(100'000, ' '))) {
    }
    if (reply.way == Reply::Way::hangs)
        (void)testing::eventually([&] { return stop_.load(); }, std::chrono::hours{1});
}

}  // namespace stormcellar::testing
