// bench/kept_client.h -- one client of HTTP that keeps its connection, and times each answer.
//
// Threads   One thread at a time.
// Errors    io if there is no connection or the answer is cut; internal if it has no
//           Content-Length.
#pragma once

#include <string>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct TimedAnswer {
    int status = 0;
    std::string body;
    // From the first byte of the request, or from the connecting if a connection had to be made, to
    // the last byte of the answer.
    double ms = 0;
};

class KeptClient {
  public:
    // The server is 127.0.0.1:`port`.
    explicit KeptClient(int port) : port_(port) {}
    // Sends a GET. A connection that the server closed after its last answer is made again.
    [[nodiscard]] Result<TimedAnswer> get(const std::string& path);
    // Counts the connections that were made.
    [[nodiscard]] int connections() const { return connections_; }

  private:
    [[nodiscard]] Status connect();
    [[nodiscard]] Result<std::string> read_head();
    [[nodiscard]] Status read_more();
    [[nodiscard]] Status read_body(const std::string& head, std::string& body);

    const int port_;
    int connections_ = 0;
    Descriptor socket_;
    std::string unread_;
};

}  // namespace stormcellar::bench
