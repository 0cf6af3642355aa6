#include "bench/event_clients.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::bench {
namespace {

using EventClock = std::chrono::steady_clock;

// The value of a key in a line of JSON that our server wrote: "" if there is none.
std::string value_of(std::string_view json, std::string_view key) {
    const std::string sought = '"' + std::string(key) + "\":\"";
    const std::size_t at = json.find(sought);
    if (at == std::string_view::npos) return {};
    const std::size_t begin = at + sought.size();
    return std::string(json.substr(begin, json.find('"', begin) - begin));
}

struct Client {
    Descriptor socket;
    std::string unread;
};

// Sends the request and reads the head of the answer; what follows it stays in `unread`.
Result<Client> open_stream(int port, const std::string& query) {
    Client client{Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), {}};
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const std::string request =
        "GET /api/v1/events?" + query + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    if (::connect(client.socket.number(), reinterpret_cast<const sockaddr*>(&address),
                  sizeof address) != 0 ||
        ::send(client.socket.number(), request.data(), request.size(), MSG_NOSIGNAL) !=
            static_cast<ssize_t>(request.size()))
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

struct EventClients::Impl {
    std::vector<Client> clients;
    Descriptor epoll{::epoll_create1(EPOLL_CLOEXEC)};
    std::atomic<bool> is_stopping = false;
    std::atomic<std::size_t> closed = 0;
    std::mutex mutex;
    std::condition_variable more;
    std::vector<HeardEvent> heard;  // guarded by mutex
    std::thread thread;

    void read_on();
    void read_client(std::size_t index);
};

// Sizes of chunks stand between the frames, on lines of their own, and are skipped with them.
void EventClients::Impl::read_client(std::size_t index) {
    Client& client = clients[index];
    std::array<char, 16384> buffer{};
    const ssize_t count =
        ::recv(client.socket.number(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (count == 0) {
        ++closed;
        ::epoll_ctl(epoll.number(), EPOLL_CTL_DEL, client.socket.number(), nullptr);
    }
    if (count <= 0) return;
    const auto now = EventClock::now();
    client.unread.append(buffer.data(), static_cast<std::size_t>(count));
    std::size_t end = 0;
    while ((end = client.unread.find("\n\n")) != std::string::npos) {
        const std::string_view frame = std::string_view(client.unread).substr(0, end);
        const std::size_t data = frame.find("data: ");
        if (data != std::string_view::npos) {
            const std::string_view json = frame.substr(data);
            const std::scoped_lock lock(mutex);
            heard.push_back({index, now, value_of(json, "type"), value_of(json, "station"),
                             value_of(json, "grid")});
            more.notify_one();
        }
        client.unread.erase(0, end + 2);
    }
}

void EventClients::Impl::read_on() {
    std::array<epoll_event, 256> ready{};
    while (!is_stopping) {
        const int count = ::epoll_wait(epoll.number(), ready.data(), ready.size(), 100);
        for (int i = 0; i < count; ++i)
            read_client(ready[static_cast<std::size_t>(i)].data.u64);
    }
}

EventClients::EventClients(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<EventClients>> EventClients::open(int port,
                                                         const std::vector<std::string>& queries) {
    auto impl = std::make_unique<Impl>();
    for (const std::string& query : queries) {
        auto client = open_stream(port, query);
        if (!client) return pass_on(client);
        impl->clients.push_back(std::move(*client));
        epoll_event wanted{};
        wanted.events = EPOLLIN;
        wanted.data.u64 = impl->clients.size() - 1;
        ::epoll_ctl(impl->epoll.number(), EPOLL_CTL_ADD, impl->clients.back().socket.number(),
                    &wanted);
    }
    impl->thread = std::thread([reading = impl.get()] { reading->read_on(); });
    return std::unique_ptr<EventClients>(new EventClients(std::move(impl)));
}

EventClients::~EventClients() {
    impl_->is_stopping = true;
    impl_->thread.join();
}

std::vector<HeardEvent> EventClients::take() {
    const std::scoped_lock lock(impl_->mutex);
    return std::exchange(impl_->heard, {});
}

std::optional<HeardEvent> EventClients::wait_for(const std::vector<std::string>& types,
                                                 std::chrono::milliseconds most) {
    const auto until = EventClock::now() + most;
    std::unique_lock lock(impl_->mutex);
    while (true) {
        for (const HeardEvent& event : std::exchange(impl_->heard, {}))
            if (std::find(types.begin(), types.end(), event.type) != types.end()) return event;
        if (impl_->more.wait_until(lock, until) == std::cv_status::timeout && impl_->heard.empty())
            return std::nullopt;
    }
}

std::size_t EventClients::closed() const {
    return impl_->closed;
}

}  // namespace stormcellar::bench
