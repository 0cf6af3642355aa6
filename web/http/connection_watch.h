// web/http/connection_watch.h -- counts connections, and cuts off connections that take too long.
//
// The timeout of libmicrohttpd is for inactivity, so a client that sends a byte every few seconds
// would hold a connection forever. This watch limits the total time in which a request must arrive,
// and the rate and total time of a body. It ends a connection by shutdown(2), and libmicrohttpd
// then closes it. libmicrohttpd does not look at a connection whose stream has nothing to send. The
// watch looks at such a connection, and ends the stream if the client is gone.
//
// Threads   Many threads may use it. Its own thread looks twice a second.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/steady_time.h"
#include "stormcellar/base/mutex.h"
#include "web/http/server_options.h"
#include "web/http/stream_feed.h"

struct MHD_Connection;

namespace stormcellar::web {

class ConnectionWatch {
  public:
    ConnectionWatch(ServerLimits limits, std::set<std::string> exempt);
    ConnectionWatch(const ConnectionWatch&) = delete;
    ConnectionWatch& operator=(const ConnectionWatch&) = delete;
    ~ConnectionWatch();

    // Returns false if this client, or all clients together, have too many connections. Connections
    // with streams do not count, because their doors limit them.
    [[nodiscard]] bool may_open(const std::string& client) const;
    // Call it when a connection has opened. If three quarters of the connections are open, ends the
    // connection that has waited longest for a request. If seven eighths are open, also ends
    // connections that are sending a body. Bodies below twenty times the least rate come first;
    // among these, a body of the client with the most connections. Streams do not count.
    void opened(MHD_Connection* connection, int descriptor, std::string client);
    void closed(MHD_Connection* connection);
    void request_arrived(MHD_Connection* connection);
    // Call it when the server begins to send a body or a stream. A stream may have nothing to send
    // for long. `holds_memory` is true if the answer budget counts the body.
    void sending_body(MHD_Connection* connection, std::uint64_t bytes, bool holds_memory = false);
    void sending_stream(MHD_Connection* connection, const std::shared_ptr<StreamFeed>& stream);
    void answered(MHD_Connection* connection);
    // Call it when an answer was refused because memory is short. The watch then ends the
    // connections of up to 16 bodies that hold memory, the slowest first. It spares clients that
    // take at least twenty times the least rate.
    void memory_is_short() { is_memory_short_ = true; }
    [[nodiscard]] std::size_t count() const;  // including streams
    // Returns true if no answer is being made or sent, and no new connection is so young that it
    // may still send its first request.
    [[nodiscard]] bool is_idle() const;

  private:
    enum class Phase { request, thinking, body, stream };
    struct Open {
        int descriptor = -1;
        std::string client;  // name under which the client is counted
        Phase phase = Phase::request;
        SteadyTime since;                       // start of the phase, or the last look at the rate
        std::uint64_t taken_bytes = 0;          // acknowledged by the client until `since`
        SteadyTime began = {};                  // start of the phase
        std::uint64_t acknowledged_before = 0;  // acknowledged by the client until `began`
        std::uint64_t body_bytes = 0;
        bool holds_memory = false;
        bool is_cut = false;
        std::weak_ptr<StreamFeed> stream = {};
    };
    void run() STORMCELLAR_EXCLUDES(mutex_);
    using Streams = std::vector<std::shared_ptr<StreamFeed>>;
    // Cuts off connections. Returns the streams that the caller must end after it has released the
    // lock.
    [[nodiscard]] Streams look(SteadyTime now) STORMCELLAR_REQUIRES(mutex_);
    void cut_those_gone() STORMCELLAR_REQUIRES(mutex_);
    bool is_too_slow(Open& open, SteadyTime now) const;
    void set_phase(MHD_Connection* connection, Phase phase, std::uint64_t body_bytes = 0,
                   bool holds_memory = false) STORMCELLAR_EXCLUDES(mutex_);
    void make_room() STORMCELLAR_REQUIRES(mutex_);
    void cut_slowest_bodies(SteadyTime now) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] Open* longest_without_request() STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] Open* slowest_body(SteadyTime now) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] Open* slowest_that_holds_memory(SteadyTime now) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] bool takes_too_long(const Open& open, SteadyTime now) const;
    // Returns the name under which the connections of a client are counted. A proxy that may have
    // all connections is counted by its own address.
    [[nodiscard]] std::string name_of(const std::string& client) const;
    void count_client(const std::string& client) STORMCELLAR_REQUIRES(mutex_);
    void forget_client(const std::string& client) STORMCELLAR_REQUIRES(mutex_);
    static void cut(Open& open);
    // Returns the average rate since `began`, in bytes a second.
    static double rate_of(const Open& open, SteadyTime now);

    const ServerLimits limits_;
    const std::set<std::string> exempt_;
    std::atomic<bool> is_memory_short_ = false;
    mutable Mutex mutex_;
    ConditionVariable ends_;
    bool is_stopping_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    std::map<MHD_Connection*, Open> open_ STORMCELLAR_GUARDED_BY(mutex_);
    // Number of streams in open_.
    std::size_t streams_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    // Connections of each client, without streams.
    std::map<std::string, unsigned> by_client_ STORMCELLAR_GUARDED_BY(mutex_);
    std::thread thread_;
};

}  // namespace stormcellar::web
