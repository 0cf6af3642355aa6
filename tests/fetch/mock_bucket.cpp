#include "tests/fetch/mock_bucket.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/testing/waiting.h"

namespace stormcellar::fetch {
namespace {

constexpr std::string_view modified = "Sun, 01 Jan 2017 03:07:30 GMT";

std::string percent_decoded(const std::string& text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size()) {
            decoded += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return decoded;
}

std::string parameter(const std::string& query, const std::string& name) {
    const std::size_t at = query.find(name + "=");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 1;
    return percent_decoded(query.substr(begin, query.find('&', begin) - begin));
}

bool send_all(int connection, std::string_view text) {
    while (!text.empty()) {
        const ssize_t sent = ::send(connection, text.data(), text.size(), MSG_NOSIGNAL);
        if (sent <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

std::string tag_of(const std::string& contents) {
    return fmt::format("\"{:x}\"", std::hash<std::string>{}(contents));
}

std::string read_head(int connection) {
    std::string head;
    char c = 0;
    while (!head.ends_with("\r\n\r\n") && ::recv(connection, &c, 1, 0) == 1)
        head += c;
    return head;
}

}  // namespace

MockBucket::MockBucket() {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(listener_, 64) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        throw std::runtime_error("no socket for the bucket");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
}

MockBucket::~MockBucket() {
    stop_ = true;
    thread_.join();
    for (std::thread& one : answering_)
        one.join();
    ::close(listener_);
}

std::string MockBucket::address() const {
    return fmt::format("http://127.0.0.1:{}", port_);
}

void MockBucket::put(const std::string& key, std::string contents) {
    const std::scoped_lock lock(mutex_);
    objects_[key] = std::move(contents);
}

void MockBucket::fail_next(const std::string& key, std::vector<Fault> faults) {
    const std::scoped_lock lock(mutex_);
    faults_[key].assign(faults.begin(), faults.end());
}

std::size_t MockBucket::asked(const std::string& key) const {
    const std::scoped_lock lock(mutex_);
    const auto found = asked_.find(key);
    return found == asked_.end() ? 0 : found->second;
}

std::size_t MockBucket::last_from(const std::string& key) const {
    const std::scoped_lock lock(mutex_);
    const auto found = last_from_.find(key);
    return found == last_from_.end() ? 0 : found->second;
}

MockBucket::Fault MockBucket::next_fault(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    ++asked_[key];
    auto& due = faults_[key];
    if (due.empty()) return Fault::none;
    const Fault fault = due.front();
    due.pop_front();
    return fault;
}

void MockBucket::serve() {
    while (!stop_) {
        pollfd ready{listener_, POLLIN, 0};
        if (::poll(&ready, 1, 20) != 1) continue;
        const int connection = ::accept(listener_, nullptr, nullptr);
        if (connection < 0) continue;
        answering_.emplace_back([this, connection] {
            most_at_once_ = std::max<std::size_t>(most_at_once_, ++at_once_);
            answer(connection);
            --at_once_;
            ::close(connection);
        });
    }
}

std::string MockBucket::listing(const std::string& prefix, const std::string& token) {
    const std::scoped_lock lock(mutex_);
    std::string entries;
    std::size_t count = 0;
    std::string next;
    for (auto one = objects_.lower_bound(std::max(prefix, token)); one != objects_.end(); ++one) {
        if (!one->first.starts_with(prefix)) break;
        if (count++ == page_) {
            next = one->first;
            break;
        }
        entries += fmt::format(
            "<Contents><Key>{}</Key><LastModified>2017-01-01T03:07:30.000Z"
            "</LastModified><ETag>{}</ETag><Size>{}</Size></Contents>",
            one->first, tag_of(one->second), one->second.size());
    }
    return fmt::format(
        "<?xml version=\"1.0\"?><ListBucketResult><IsTruncated>{}</IsTruncated>{}{}"
        "</ListBucketResult>",
        !next.empty(), entries,
        next.empty() ? ""
                     : fmt::format("<NextContinuationToken>{}</"
                                   "NextContinuationToken>",
                                   next));
}

void MockBucket::answer(int connection) {
    const std::string head = read_head(connection);
    const std::string target = head.substr(4, head.find(' ', 4) - 4);
    const std::size_t question = target.find('?');
    const bool lists = question != std::string::npos;
    const std::string key = lists ? parameter(target, "prefix") : percent_decoded(target.substr(1));
    const Fault fault = next_fault(key);
    std::string body;
    std::size_t from = 0;
    bool known = true;
    if (lists) {
        body = listing(key, parameter(target, "continuation-token"));
        if (fault == Fault::no_xml) body = "<html>not now</html>";
    } else {
        const std::scoped_lock lock(mutex_);
        const auto object = objects_.find(key);
        known = object != objects_.end();
        if (known) body = object->second;
        const std::size_t range = head.find("Range: bytes=");
        if (range != std::string::npos) from = std::stoul(head.substr(range + 13));
        last_from_[key] = from;
        const std::size_t match = head.find("If-Match: ");
        const bool changed = match != std::string::npos &&
                             !std::string_view{head}.substr(match + 10).starts_with(tag_of(body));
        if (changed || fault == Fault::changed) {
            send_all(connection,
                     "HTTP/1.1 412 Precondition Failed\r\nContent-Length: 0\r\n"
                     "Connection: close\r\n\r\n");
            return;
        }
    }
    if (fault == Fault::unavailable || fault == Fault::missing || !known) {
        const int status = fault == Fault::unavailable ? 503 : 404;
        send_all(connection, fmt::format("HTTP/1.1 {} No\r\nContent-Length: 4\r\n"
                                         "Connection: close\r\n\r\nnone",
                                         status));
        return;
    }
    if (fault == Fault::endless_error) {
        send_all(connection, "HTTP/1.1 403 No\r\nConnection: close\r\n\r\n");
        while (!stop_ && send_all(connection, std::string(100'000, 'x'))) {
        }
        return;
    }
    if (fault == Fault::longer) body += "and more";
    if (fault == Fault::shorter) body.resize(body.size() / 2);
    const std::string rest = body.substr(std::min(from, body.size()));
    const std::size_t said = fault == Fault::other_part ? 0 : from;
    send_all(connection, fmt::format("HTTP/1.1 {}\r\nContent-Length: {}\r\nLast-Modified: {}\r\n"
                                     "Content-Range: bytes {}-{}/{}\r\nConnection: close\r\n\r\n",
                                     from > 0 ? "206 Partial Content" : "200 OK", rest.size(),
                                     modified, said, said + rest.size() - 1, body.size()));
    const bool half = fault == Fault::cut || fault == Fault::stalled;
    send_all(connection, std::string_view{rest}.substr(0, half ? rest.size() / 2 : rest.size()));
    if (fault == Fault::stalled)
        (void)testing::eventually([this] { return stop_.load(); }, std::chrono::seconds{4});
}

}  // namespace stormcellar::fetch
