// web/http/server_options.h -- where the server listens, whom it answers, and its limits.
//
// Threads   Plain data.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "web/http/request.h"

namespace stormcellar::web {

struct ListenAddress {
    std::string address = "127.0.0.1";  // of IPv4 or IPv6, without brackets
    int port = 0;                       // 0: any that is free
    bool operator==(const ListenAddress&) const = default;
};

struct ServerLimits {
    unsigned most_connections = 1024;  // but for those that carry a stream
    unsigned most_streams = 2048;      // that doors make: the server has room for them
    // Limit of one client: an IPv4 address or an IPv6 /64 network. Trusted proxies may have all.
    unsigned most_connections_of_address = 256;
    std::size_t header_bytes = 32 * 1024;  // request line and headers together
    // From the opening of a connection, or the end of the previous answer, to the end of a
    // request's headers.
    std::chrono::seconds request_time{20};
    // A client that takes less than this of a waiting body, on the mean of such a time, is cut off.
    // 0: never.
    std::uint64_t least_bytes_per_s = 1000;
    std::chrono::seconds rate_time{30};
    // A client is also cut off if it has not taken a whole body after this time and the time that
    // the body takes at twenty times that rate.
    std::chrono::seconds answer_time{60};
    // Limit of the memory of answers on their way (web/http/answer_budget.h); beyond: 503.
    std::uint64_t answer_bytes = 256'000'000;
    unsigned workers = 4;           // threads that make answers
    std::size_t most_waiting = 64;  // requests that wait for a worker; beyond: 503
};

// One answer, for the log and for metrics.
struct Served {
    const Request* request = nullptr;  // null if it could not be read
    unsigned status = 0;
    std::uint64_t bytes = 0;                   // of the body; 0 for streams
    std::chrono::duration<double> seconds{0};  // until the answer was made
    std::string_view trouble = {};             // what went wrong that the client is not told
};

struct ServerOptions {
    std::vector<ListenAddress> listen = {{}};
    // Host fields that are answered beside the loopback names and the addresses of `listen`. "*":
    // any.
    std::vector<std::string> names;
    // The address under which clients reach the server; empty: what Host says.
    std::string public_address;
    // The path under which a proxy passes requests on, for example "/storms"; empty: none.
    std::string prefix;
    // Addresses whose Forwarded and X-Forwarded fields count.
    std::vector<std::string> trusted_proxies;
    bool any_origin = false;  // Access-Control-Allow-Origin: *
    ServerLimits limits;
    std::function<void(const Served&)> on_answer;  // any thread calls it; may be empty
};

}  // namespace stormcellar::web
