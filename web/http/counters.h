// web/http/counters.h -- counts the server's requests and answers for /metrics.
//
// The server's `on_answer` (web/http/server_options.h) calls count(). Labels are the prefixes of
// doors, so clients cannot create labels. Other rooms add gauges and counters as functions, which
// are called when /metrics is requested.
//
// Units     Seconds and bytes.
// Threads   Doors, gauges and counters are added before the server starts. After that, many threads
//           may use the object; counting takes no lock.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "service/metrics_writer.h"
#include "web/http/server_options.h"

namespace stormcellar::web {

// The statuses that the server sends. All other statuses are counted as status 0.
inline constexpr std::array<unsigned, 22> counted_statuses = {
    200, 204, 206, 301, 302, 304, 308, 400, 403, 404, 405,
    406, 410, 412, 414, 416, 421, 429, 431, 500, 501, 503};
// Upper bounds of the histogram of seconds. The bound "infinity" is not in the list.
inline constexpr std::array<double, 9> counted_seconds = {0.0005, 0.002, 0.01, 0.05, 0.1,
                                                          0.5,    1,     5,    30};

class Counters {
  public:
    // Counts requests below this prefix ("/tiles") separately. All other requests count as "other";
    // requests that could not be read count as "unread".
    void add_door(std::string prefix);
    // Add a gauge, which rises and falls, or a counter, which only rises. `name` is the name of the
    // metric family, such as "stormcellar_web_kept_bytes".
    void add_gauge(std::string name, std::string help, std::function<double()> value,
                   Fields labels = {});
    void add_counter(std::string name, std::string help, std::function<double()> value);

    void count(const Served& served);

    // Returns all metrics in the text format of Prometheus, version 0.0.4.
    [[nodiscard]] std::string text() const;

  private:
    struct PerDoor {
        std::string prefix;
        std::array<std::atomic<std::uint64_t>, counted_statuses.size() + 1> statuses{};
        std::array<std::atomic<std::uint64_t>, counted_seconds.size() + 1> buckets{};
        std::atomic<std::uint64_t> bytes{0}, microseconds{0};
    };
    struct Function {
        std::string name, help;
        Fields labels;
        MetricsWriter::Type type;
        std::function<double()> value;
    };
    PerDoor& door_of(const Request* request);
    [[nodiscard]] std::vector<const PerDoor*> all_doors() const;

    std::deque<PerDoor> doors_;
    PerDoor other_{"other"}, unread_{"unread"};
    std::vector<Function> functions_;
};

}  // namespace stormcellar::web
