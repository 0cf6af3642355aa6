// bench/web_load.h -- starts HTTP servers as children, and puts a load on the servers.
//
// The load generator is wrk. If there are two processors, wrk and the server run on different
// processors.
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

// A running server. The destructor ends it by SIGTERM, so that the server can remove its files.
struct WebServer {
    ChildProcess process;
    int port = 0;

    WebServer(ChildProcess started, int at) : process(std::move(started)), port(at) {}
    WebServer(WebServer&&) noexcept = default;
    WebServer& operator=(WebServer&&) noexcept = default;
    ~WebServer() { process.stop(); }

    // Returns "http://127.0.0.1:PORT" without a slash at the end.
    [[nodiscard]] std::string address() const;
};
// Starts `stormcellar serve` with these arguments. Returns when it answers.
[[nodiscard]] Result<WebServer> serve(const std::vector<std::string>& words,
                                      const std::filesystem::path& scratch,
                                      std::optional<int> processor = std::nullopt);
// Starts `stormcellar-web` with this configuration, whose [web] listen must be 127.0.0.1:`port`.
// The server may run on any processor.
[[nodiscard]] Result<WebServer> serve_configured(const std::filesystem::path& configuration,
                                                 int port, const std::filesystem::path& scratch);
// Starts nginx as one process that serves the files of a directory with sendfile, without a log.
[[nodiscard]] Result<WebServer> serve_with_nginx(const std::filesystem::path& directory,
                                                 const std::filesystem::path& scratch);

// The answer to one GET of curl, without other load.
struct Fetched {
    int status = 0;
    double ms = 0;  // from the request to the last byte
};
// Requests the paths one after another on one connection, which is opened again if the server
// closes it. Drops the bodies, or keeps only the last body. Errors: also internal for any status
// but 200.
[[nodiscard]] Result<std::vector<Fetched>> get_all(const WebServer& server,
                                                   const std::vector<std::string>& paths,
                                                   const std::vector<std::string>& headers,
                                                   const std::filesystem::path& scratch,
                                                   std::string* body = nullptr);

struct Load {
    double requests_per_s = 0, mb_per_s = 0;
    double p50_ms = 0, p99_ms = 0;
    double cpu_cores = 0;  // CPU time of the server over wall time
    long failed = 0;       // requests without an answer, or with a status outside 200 to 399
};
[[nodiscard]] Result<Load> load(const WebServer& server, const std::string& path,
                                const std::vector<std::string>& headers, int clients,
                                std::chrono::seconds time, const std::filesystem::path& scratch);

}  // namespace stormcellar::bench
