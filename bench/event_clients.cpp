#include "bench/event_clients.h"

#include <array>
#include <atomic>
#include <string_view>
#include <thread>
#include <utility>

#include <sys/epoll.h>
#include <sys/socket.h>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"
#include "tests/testing/loopback.h"

namespace stormcellar::bench {
namespace {

using Clock = std::chrono::steady_clock;

// Returns the value of a key in a line of our server's JSON; empty if the key is absent.
std::string value_of(std::string_view json, std::string_view key) {
    const std::string sought = '"' + std::string(key) + "\":\"";
    const std::size_t at = json.find(sought);
    if (at == std::string_view::npos) return {};
    const std::size_t begin = at + sought.size();
    return std::string(json.substr(begin, json.find('"', begin) - begin));
}

struct Stream {
    Descriptor socket;
    std::string unread;
};

// Sends the request and reads the head of the answer. Puts the bytes after the head into `unread`.
Result<Stream> open_stream(int port, const std::string& query) {
    Stream client{testing::connection_to(port), {}};
    const std::string request =
        "GET /api/v1/events?" + query + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    if (!client.socket.is_open() || ::send(client.socket.number(), request.data(), request.size(),
                                           MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
        return fail(ErrorCode::io, "no connection to port {}", port);
    std::array<char, 4096> buffer{};
    while (client.unread.find("\r\n\r\n") == std::string::npos) {
        const ssize_t count = ::recv(client.socket.number(), buffer.data(), buffer.size(), 0);
        if (count <= 0) return fail(ErrorCode::io, "the server closed a connection");
        client.unread.append(buffer.data(), static_cast<std::size_t>(count));
    }
    if (!client.unread.starts_with("HTTP/1.1 200"))
        return fail(ErrorCode::io, "a stream was refused: {}", client.unread);
    client.unread.erase(0, client.unread.find("\r\n\r\n") + 4);
    return client;
}

}  // namespace

// Reads the events of all clients in one thread.
class EventClients::Reader {
  public:
    // Adds a client. Call it before start().
    void add(Stream stream) {
        epoll_event wanted{};
        wanted.events = EPOLLIN;
        wanted.data.u64 = streams_.size();
        streams_.push_back(std::move(stream));
        ::epoll_ctl(epoll_.number(), EPOLL_CTL_ADD, streams_.back().socket.number(), &wanted);
    }
    void start() {
        thread_ = std::jthread([this](const std::stop_token& stop) { read_on(stop); });
    }
    [[nodiscard]] std::vector<HeardEvent> take() {
        const MutexLock lock(mutex_);
        return std::exchange(heard_, {});
    }
    [[nodiscard]] std::size_t closed() const { return closed_; }

  private:
    void read_on(const std::stop_token& stop) {
        std::array<epoll_event, 256> ready{};
        while (!stop.stop_requested()) {
            const int count = ::epoll_wait(epoll_.number(), ready.data(), ready.size(), 100);
            for (int i = 0; i < count; ++i)
                read_stream(ready[static_cast<std::size_t>(i)].data.u64);
        }
    }
    // Skips the lines with the sizes of chunks, which are between the events.
    void read_stream(std::size_t index) {
        Stream& stream = streams_[index];
        std::array<char, 16384> buffer{};
        const ssize_t count =
            ::recv(stream.socket.number(), buffer.data(), buffer.size(), MSG_DONTWAIT);
        if (count == 0) {
            ++closed_;
            ::epoll_ctl(epoll_.number(), EPOLL_CTL_DEL, stream.socket.number(), nullptr);
        }
        if (count <= 0) return;
        const auto now = Clock::now();
        stream.unread.append(buffer.data(), static_cast<std::size_t>(count));
        std::size_t end = 0;
        while ((end = stream.unread.find("\n\n")) != std::string::npos) {
            const std::string_view frame = std::string_view(stream.unread).substr(0, end);
            const std::size_t data = frame.find("data: ");
            if (data != std::string_view::npos) {
                const std::string_view json = frame.substr(data);
                const MutexLock lock(mutex_);
                heard_.push_back({index, now, value_of(json, "type"), value_of(json, "station"),
                                  value_of(json, "grid")});
            }
            stream.unread.erase(0, end + 2);
        }
    }

    std::vector<Stream> streams_;
    Descriptor epoll_{::epoll_create1(EPOLL_CLOEXEC)};
    std::atomic<std::size_t> closed_ = 0;
    Mutex mutex_;
    std::vector<HeardEvent> heard_ STORMCELLAR_GUARDED_BY(mutex_);
    std::jthread thread_;  // declared last, because it uses the members above
};

EventClients::EventClients() : reader_(std::make_unique<Reader>()) {}
EventClients::~EventClients() = default;

Result<std::unique_ptr<EventClients>> EventClients::open(int port,
                                                         const std::vector<std::string>& queries) {
    auto clients = std::make_unique<EventClients>();
    for (const std::string& query : queries) {
        auto stream = open_stream(port, query);
        if (!stream) return pass_on(stream);
        clients->reader_->add(std::move(*stream));
    }
    clients->reader_->start();
    return clients;
}

std::vector<HeardEvent> EventClients::take() {
    return reader_->take();
}

std::size_t EventClients::closed() const {
    return reader_->closed();
}

}  // namespace stormcellar::bench
