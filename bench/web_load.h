// bench/web_load.h -- servers of HTTP as children, and a load on them.
//
// The load generator is wrk, on another processor than the server's where there are two.
//
// Threads   One thread at a time.
// Errors    not_found if wrk, nginx or stormcellar cannot be run; io.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/process.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

inline constexpr int processor_of_servers = 0;

// A server that answers. It is asked to end, so that it removes what it made.
struct WebServer {
    ChildProcess process;
    int port = 0;

    WebServer(ChildProcess started, int at) : process(std::move(started)), port(at) {}
    WebServer(WebServer&&) noexcept = default;
    WebServer& operator=(WebServer&&) noexcept = default;
    ~WebServer() { process.stop(); }

    // "http://127.0.0.1:PORT" without a slash at the end.
    [[nodiscard]] std::string address() const;
};
// `stormcellar serve` with these words behind it. Returns when it answers.
[[nodiscard]] Result<WebServer> serve(const std::vector<std::string>& words,
                                      const std::filesystem::path& scratch,
                                      std::optional<int> processor = std::nullopt);
// `stormcellar-web` with this configuration, whose [web] listen is 127.0.0.1:`port`. It runs on any
// processor.
[[nodiscard]] Result<WebServer> serve_configured(const std::filesystem::path& configuration,
                                                 int port, const std::filesystem::path& scratch);
// nginx as one process that serves the files of a directory with sendfile, without a log.
[[nodiscard]] Result<WebServer> serve_with_nginx(const std::filesystem::path& directory,
                                                 const std::filesystem::path& scratch);

// The answer to one GET without a load: curl is the client.
struct Fetched {
    int status = 0;
    double ms = 0;  // from the request to the last byte
};
// Asks for one path after another by one connection, which is made again where the server closes
// it. Drops the bodies, or keeps that of the last one. Errors, also: internal for any other status
// than 200.
[[nodiscard]] Result<std::vector<Fetched>> get_all(const WebServer& server,
                                                   const std::vector<std::string>& paths,
                                                   const std::vector<std::string>& headers,
                                                   const std::filesystem::path& scratch,
                                                   std::string* body = nullptr);

struct Load {
    double requests_per_s = 0, mb_per_s = 0;
    double p50_ms = 0, p99_ms = 0;
    double cpu_cores = 0;  // of the server
    long failed = 0;       // requests that were not answered, or not with 200 to 399
};
[[nodiscard]] Result<Load> load(const WebServer& server, const std::string& path,
                                const std::vector<std::string>& headers, int clients,
                                std::chrono::seconds time, const std::filesystem::path& scratch);

}  // namespace stormcellar::bench
