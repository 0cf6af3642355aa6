#include "web/http/connection_watch.h"

#include <algorithm>
#include <exception>
#include <tuple>
#include <utility>

#include <linux/sockios.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "web/http/client_address.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::milliseconds look_every{500};
// The rate of a body is not judged before it has been sent for this long.
constexpr std::chrono::seconds rate_is_known_after{5};
// A client that takes a body at this multiple of the least rate is cut off only if memory is short.
constexpr std::uint64_t times_least_rate = 20;
// Most connections that are cut off in one look, because each cut scans all bodies while other
// threads wait for the lock.
constexpr int most_cut_at_once = 16;
// A new connection that has sent nothing for this long counts as idle.
constexpr std::chrono::milliseconds first_words_within{250};
// Number of bytes of a body that may wait in the kernel beyond the client's window, with few
// connections and with many. The larger number is what Linux holds by default, and more than most
// packed grids. With the smaller number, a volume takes twice the processor time, because the
// server is woken for small pieces. With the larger number, slow readers on all connections would
// take gigabytes.
constexpr int most_unsent_of_few = 4 * 1024 * 1024, most_unsent_of_many = 256 * 1024;
constexpr std::size_t few_connections = 64;

// Returns how many bytes the other side has acknowledged since the connection was opened.
std::uint64_t acknowledged_bytes(int descriptor) {
    tcp_info info{};
    socklen_t size = sizeof info;
    if (::getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
    return info.tcpi_bytes_acked;
}

bool has_unsent(int descriptor) {
    int bytes = 0;
    return ::ioctl(descriptor, SIOCOUTQ, &bytes) == 0 && bytes > 0;
}

}  // namespace

ConnectionWatch::ConnectionWatch(ServerLimits limits, std::set<std::string> exempt)
    : limits_(limits), exempt_(std::move(exempt)), thread_([this] { run(); }) {}

void ConnectionWatch::run() {
    const MutexLock lock(mutex_);
    while (true) {
        const SteadyTime next_look = steady_now() + look_every;
        while (!is_stopping_ && steady_now() < next_look)
            ends_.wait_until(mutex_, next_look);
        if (is_stopping_) return;
        Streams over;
        try {
            over = look(std::chrono::steady_clock::now());
        } catch (const std::exception&) {
            // Memory is short; the next look does the rest.
        }
        const MutexUnlock unlocked(mutex_);
        for (const auto& stream : over)
            stream->end();
    }
}

ConnectionWatch::~ConnectionWatch() {
    {
        const MutexLock lock(mutex_);
        is_stopping_ = true;
    }
    ends_.notify_all();
    thread_.join();
}

bool ConnectionWatch::may_open(const std::string& client) const {
    const MutexLock lock(mutex_);
    if (open_.size() - streams_ >= limits_.most_connections) return false;
    const auto theirs = by_client_.find(name_of(client));
    return theirs == by_client_.end() || exempt_.contains(client) ||
           theirs->second < limits_.most_connections_of_address;
}

void ConnectionWatch::opened(MHD_Connection* connection, int descriptor, std::string client) {
    const MutexLock lock(mutex_);
    make_room();
    const bool are_few = open_.size() - streams_ < few_connections;
    const int unsent = are_few ? most_unsent_of_few : most_unsent_of_many;
    ::setsockopt(descriptor, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent, sizeof unsent);
    std::string name = name_of(client);
    count_client(name);
    open_[connection] = {.descriptor = descriptor,
                         .client = std::move(name),
                         .since = std::chrono::steady_clock::now()};
}

void ConnectionWatch::closed(MHD_Connection* connection) {
    const MutexLock lock(mutex_);
    const auto found = open_.find(connection);
    if (found == open_.end()) return;
    if (found->second.phase == Phase::stream) {
        --streams_;
    } else {
        forget_client(found->second.client);
    }
    open_.erase(found);
}

std::string ConnectionWatch::name_of(const std::string& client) const {
    return exempt_.contains(client) ? client : client_network(client);
}

void ConnectionWatch::count_client(const std::string& client) {
    ++by_client_[client];
}

void ConnectionWatch::forget_client(const std::string& client) {
    const auto theirs = by_client_.find(client);
    if (--theirs->second == 0) by_client_.erase(theirs);
}

void ConnectionWatch::set_phase(MHD_Connection* connection, Phase phase, std::uint64_t body_bytes,
                                bool holds_memory) {
    const MutexLock lock(mutex_);
    const auto found = open_.find(connection);
    if (found == open_.end()) return;
    Open& open = found->second;
    if (phase == Phase::stream && open.phase != Phase::stream) {
        ++streams_;
        forget_client(open.client);
    } else if (phase != Phase::stream && open.phase == Phase::stream) {
        --streams_;
        count_client(open.client);
    }
    open.phase = phase;
    open.since = open.began = std::chrono::steady_clock::now();
    open.body_bytes = body_bytes;
    open.holds_memory = holds_memory;
    if (phase == Phase::body || phase == Phase::stream)
        open.taken_bytes = open.acknowledged_before = acknowledged_bytes(open.descriptor);
}

void ConnectionWatch::request_arrived(MHD_Connection* connection) {
    set_phase(connection, Phase::thinking);
}

void ConnectionWatch::sending_body(MHD_Connection* connection, std::uint64_t bytes,
                                   bool holds_memory) {
    set_phase(connection, Phase::body, bytes, holds_memory);
}

void ConnectionWatch::sending_stream(MHD_Connection* connection,
                                     const std::shared_ptr<StreamFeed>& stream) {
    set_phase(connection, Phase::stream);
    const MutexLock lock(mutex_);
    const auto found = open_.find(connection);
    if (found != open_.end()) found->second.stream = stream;
}

void ConnectionWatch::answered(MHD_Connection* connection) {
    set_phase(connection, Phase::request);
}

std::size_t ConnectionWatch::count() const {
    const MutexLock lock(mutex_);
    return open_.size();
}

bool ConnectionWatch::is_idle() const {
    const MutexLock lock(mutex_);
    const SteadyTime now = std::chrono::steady_clock::now();
    return std::ranges::all_of(open_, [&](const auto& one) {
        const Open& open = one.second;
        const bool is_new = open.began == SteadyTime{} && now - open.since < first_words_within;
        return open.phase == Phase::request && !is_new;
    });
}

double ConnectionWatch::rate_of(const Open& open, SteadyTime now) {
    return static_cast<double>(acknowledged_bytes(open.descriptor) - open.acknowledged_before) /
           std::chrono::duration<double>(now - open.began).count();
}

void ConnectionWatch::cut(Open& open) {
    ::shutdown(open.descriptor, SHUT_RDWR);
    open.is_cut = true;
}

void ConnectionWatch::make_room() {
    if (4 * (open_.size() - streams_) < 3 * std::size_t{limits_.most_connections}) return;
    if (Open* oldest = longest_without_request()) cut(*oldest);
}

void ConnectionWatch::cut_slowest_bodies(SteadyTime now) {
    const std::size_t most = limits_.most_connections;
    if (8 * (open_.size() - streams_) < 7 * most) return;
    auto held = static_cast<std::size_t>(std::ranges::count_if(open_, [](const auto& one) {
        return !one.second.is_cut && one.second.phase != Phase::stream;
    }));
    for (int cuts = 0; cuts < most_cut_at_once && 8 * held >= 7 * most; ++cuts, --held) {
        Open* slowest = slowest_body(now);
        if (slowest == nullptr) return;
        cut(*slowest);
    }
}

ConnectionWatch::Open* ConnectionWatch::longest_without_request() {
    Open* oldest = nullptr;
    for (auto& [connection, open] : open_) {
        if (open.is_cut || open.phase != Phase::request) continue;
        if (oldest == nullptr || open.since < oldest->since) oldest = &open;
    }
    // A new connection may be about to send its first request.
    const bool is_new =
        oldest != nullptr && std::chrono::steady_clock::now() - oldest->since < first_words_within;
    return is_new ? nullptr : oldest;
}

// Returns the body that must be cut first. Bodies below `times_least_rate` come before other
// bodies, then bodies of clients with more connections, then slower bodies. A proxy stands for many
// clients, so it counts as if it had one connection.
ConnectionWatch::Open* ConnectionWatch::slowest_body(SteadyTime now) {
    const auto least_rate = static_cast<double>(times_least_rate * limits_.least_bytes_per_s);
    Open* slowest = nullptr;
    std::tuple<bool, unsigned, double> most;
    for (auto& [connection, open] : open_) {
        if (open.is_cut || open.phase != Phase::body || now - open.began < rate_is_known_after)
            continue;
        const unsigned theirs = exempt_.contains(open.client) ? 1 : by_client_[open.client];
        const double rate = rate_of(open, now);
        const std::tuple rank{rate < least_rate, theirs, -rate};
        if (slowest != nullptr && rank <= most) continue;
        slowest = &open;
        most = rank;
    }
    return slowest;
}

ConnectionWatch::Open* ConnectionWatch::slowest_that_holds_memory(SteadyTime now) {
    Open* slowest = nullptr;
    auto least_rate = static_cast<double>(times_least_rate * limits_.least_bytes_per_s);
    for (auto& [connection, open] : open_) {
        if (open.is_cut || !open.holds_memory || now - open.began < rate_is_known_after) continue;
        const double rate = rate_of(open, now);
        if (rate >= least_rate) continue;
        slowest = &open;
        least_rate = rate;
    }
    return slowest;
}

bool ConnectionWatch::takes_too_long(const Open& open, SteadyTime now) const {
    if (open.phase != Phase::body || limits_.least_bytes_per_s == 0) return false;
    const auto rate = static_cast<double>(times_least_rate * limits_.least_bytes_per_s);
    const std::chrono::duration<double> total =
        limits_.answer_time +
        std::chrono::duration<double>(static_cast<double>(open.body_bytes) / rate);
    return now - open.began > total && has_unsent(open.descriptor);
}

bool ConnectionWatch::is_too_slow(Open& open, SteadyTime now) const {
    if (open.phase == Phase::thinking) return false;
    if (open.phase == Phase::request) return now - open.since > limits_.request_time;
    if (takes_too_long(open, now)) return true;
    if (now - open.since < limits_.rate_time) return false;
    const std::uint64_t taken = acknowledged_bytes(open.descriptor);
    const std::uint64_t wanted =
        limits_.least_bytes_per_s * static_cast<std::uint64_t>(limits_.rate_time.count());
    const bool is_slow = taken - open.taken_bytes < wanted && has_unsent(open.descriptor);
    open.taken_bytes = taken;
    open.since = now;
    return is_slow;
}

void ConnectionWatch::cut_those_gone() {
    std::vector<pollfd> sockets;
    std::vector<Open*> streams;
    for (auto& [connection, open] : open_) {
        if (open.is_cut || open.phase != Phase::stream) continue;
        sockets.push_back({open.descriptor, POLLRDHUP, 0});
        streams.push_back(&open);
    }
    if (sockets.empty() || ::poll(sockets.data(), sockets.size(), 0) <= 0) return;
    for (std::size_t i = 0; i < sockets.size(); ++i)
        if (sockets[i].revents != 0) cut(*streams[i]);
}

ConnectionWatch::Streams ConnectionWatch::look(SteadyTime now) {
    for (auto& [connection, open] : open_)
        if (!open.is_cut && is_too_slow(open, now)) cut(open);
    cut_slowest_bodies(now);
    // Memory that many answers share becomes free only when all of them have ended.
    const int most_cut = is_memory_short_.exchange(false) ? most_cut_at_once : 0;
    for (int cuts = 0; cuts < most_cut; ++cuts) {
        Open* slowest = slowest_that_holds_memory(now);
        if (slowest == nullptr) break;
        cut(*slowest);
    }
    cut_those_gone();
    Streams over;
    for (auto& [connection, open] : open_) {
        if (!open.is_cut || open.phase != Phase::stream) continue;
        if (auto stream = open.stream.lock()) over.push_back(std::move(stream));
        open.stream.reset();
    }
    return over;
}

}  // namespace stormcellar::web
