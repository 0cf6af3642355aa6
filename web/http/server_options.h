// web/http/server_options.h -- says where the server listens, whom it answers, and what its limits
// are.
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

#include "web/http/common_headers.h"
#include "web/http/request.h"

namespace stormcellar::web {

struct ListenAddress {
    std::string address = "127.0.0.1";  // IPv4 or IPv6, without brackets
    int port = 0;                       // 0: any free port
    bool operator==(const ListenAddress&) const = default;
};

struct ServerLimits {
    unsigned most_connections = 1024;  // not counting connections with streams
    unsigned most_streams = 2048;      // room for the streams that doors make
    // Limit for one client, which is an IPv4 address or an IPv6 /64 network. Trusted proxies may
    // have all connections.
    unsigned most_connections_of_address = 256;
    std::size_t header_bytes = 32 * 1024;  // request line and headers together
    // Limit of the time for a request. It counts from the opening of the connection, or from the
    // end of the previous answer, to the end of the headers.
    std::chrono::seconds request_time{20};
    // A client is cut off if it takes a waiting body more slowly than this, averaged over
    // `rate_time`. 0: never.
    std::uint64_t least_bytes_per_s = 1000;
    std::chrono::seconds rate_time{30};
    // A client is also cut off if it has not taken a whole body after a longer time: this time,
    // plus the time that the body takes at twenty times `least_bytes_per_s`.
    std::chrono::seconds answer_time{60};
    // Limit of the memory of answers on their way (web/http/answer_budget.h). Answers beyond it get
    // 503.
    std::uint64_t answer_bytes = 256'000'000;
    unsigned workers = 4;           // threads that make answers
    std::size_t most_waiting = 64;  // requests that may wait for a worker; further requests get 503
};

// Facts about one answer, for the log and the metrics.
struct Served {
    const Request* request = nullptr;  // null: the request could not be read
    unsigned status = 0;
    std::uint64_t bytes = 0;                   // of the body; 0 for streams
    std::chrono::duration<double> seconds{0};  // until the answer was made
    std::string_view trouble = {};             // an error that the client does not see
};

struct ServerOptions {
    std::vector<ListenAddress> listen = {{}};
    // Host fields that are accepted in addition to the loopback names and the addresses of
    // `listen`. "*": any.
    std::vector<std::string> names;
    // The address under which clients reach the server; empty: the address in the field Host.
    std::string public_address;
    // The path under which a proxy forwards requests, such as "/storms"; empty: none.
    std::string prefix;
    // Addresses whose Forwarded and X-Forwarded fields are believed.
    std::vector<std::string> trusted_proxies;
    OriginRules origins;
    ServerLimits limits;
    std::function<void(const Served&)> on_answer;  // any thread calls it; may be empty
};

}  // namespace stormcellar::web
