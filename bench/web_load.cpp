#include "bench/web_load.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include "bench/measure.h"
#include "tests/testing/loopback.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds step{2};
constexpr int most_steps = 30'000;
constexpr int microseconds_in_a_millisecond = 1000;

// A script for wrk that prints requests, bytes, microseconds, latencies and failures on one line.
constexpr std::string_view report = R"(done = function(summary, latency, requests)
  local e = summary.errors
  io.write(string.format("figures %d %d %d %d %d %d\n", summary.requests, summary.bytes,
    summary.duration, latency:percentile(50), latency:percentile(99),
    e.connect + e.read + e.write + e.status + e.timeout))
end
)";

int processor_of_load() {
    return std::thread::hardware_concurrency() > 1 ? processor_of_servers + 1
                                                   : processor_of_servers;
}

// Waits until the started server listens on the port and, if `ready` is not empty, has written the
// text `ready`.
Result<WebServer> listening(Result<ChildProcess> process, int port, const std::string& name,
                            const fs::path& said, std::string_view ready = {}) {
    if (!process) return pass_on(process);
    for (int i = 0; i < most_steps && process->is_running(); ++i) {
        if (process->output().find(ready) != std::string::npos &&
            testing::connection_to(port).is_open())
            return WebServer{std::move(*process), port};
        std::this_thread::sleep_for(step);
    }
    return fail(ErrorCode::not_found, "{} did not start: see {}.err", name, said.native());
}

}  // namespace

std::string WebServer::address() const {
    return fmt::format("http://127.0.0.1:{}", port);
}

Result<WebServer> serve(const std::vector<std::string>& words, const fs::path& scratch,
                        std::optional<int> processor) {
    const int port = testing::free_port();
    std::vector<std::string> arguments = {built_program("cli/stormcellar"), "serve", "--listen",
                                          fmt::format("127.0.0.1:{}", port)};
    arguments.insert(arguments.end(), words.begin(), words.end());
    // Remove the output of an earlier server.
    std::error_code ignored;
    fs::remove(scratch / "serve", ignored);
    return listening(ChildProcess::start(std::move(arguments), scratch / "serve", processor), port,
                     "stormcellar serve", scratch / "serve", "listening on http");
}

Result<WebServer> serve_configured(const fs::path& configuration, int port,
                                   const fs::path& scratch) {
    return listening(
        ChildProcess::start({built_program("web/stormcellar-web"), "--config", configuration},
                            scratch / "web"),
        port, "stormcellar-web", scratch / "web");
}

Result<WebServer> serve_with_nginx(const fs::path& directory, const fs::path& scratch) {
    const int port = testing::free_port();
    const fs::path file = scratch / "nginx.conf";
    std::ofstream(file) << fmt::format(
        "daemon off; master_process off; pid {0}/nginx.pid; error_log {0}/nginx.log;\n"
        "events {{ worker_connections 4096; }}\n"
        "http {{ access_log off; sendfile on; tcp_nopush on; keepalive_requests 1000000000;\n"
        "client_body_temp_path {0}/body; proxy_temp_path {0}/proxy; fastcgi_temp_path {0}/fcgi;\n"
        "uwsgi_temp_path {0}/uwsgi; scgi_temp_path {0}/scgi;\n"
        "server {{ listen 127.0.0.1:{1}; root {2}; }} }}\n",
        scratch.native(), port, directory.native());
    return listening(ChildProcess::start({"nginx", "-p", scratch, "-c", file}, scratch / "nginx",
                                         processor_of_servers),
                     port, "nginx (package nginx-light)", scratch / "nginx");
}

Result<std::vector<Fetched>> get_all(const WebServer& server, const std::vector<std::string>& paths,
                                     const std::vector<std::string>& headers,
                                     const fs::path& scratch, std::string* body) {
    const fs::path list = scratch / "urls", kept = body ? scratch / "body" : fs::path("/dev/null");
    {
        std::ofstream file(list);
        for (const std::string& path : paths)
            fmt::print(file, "url = \"{}{}\"\noutput = \"{}\"\n", server.address(), path,
                       kept.native());
    }
    std::vector<std::string> arguments = {
        "curl", "--silent", "--write-out", "%{http_code} %{time_total}\n", "--config", list};
    for (const std::string& header : headers) {
        arguments.emplace_back("--header");
        arguments.push_back(header);
    }
    auto curl = ChildProcess::start(std::move(arguments), scratch / "curl", processor_of_load());
    if (!curl) return pass_on(curl);
    if (!curl->wait()) return fail(ErrorCode::not_found, "curl could not get {}", paths.front());
    std::istringstream said(curl->output());
    std::vector<Fetched> all;
    for (Fetched one; said >> one.status >> one.ms; all.push_back(one)) {
        one.ms *= 1000;
        if (one.status != 200)
            return fail(ErrorCode::internal, "{} answered {}", paths[all.size()], one.status);
    }
    if (all.size() != paths.size()) return fail(ErrorCode::internal, "curl gave no figures");
    if (body) *body = text_in(kept);
    return all;
}

Result<Load> load(const WebServer& server, const std::string& path,
                  const std::vector<std::string>& headers, int clients, std::chrono::seconds time,
                  const fs::path& scratch) {
    const fs::path script = scratch / "report.lua";
    std::ofstream(script) << report;
    std::vector<std::string> arguments = {
        "wrk", "-t1", fmt::format("-c{}", clients), fmt::format("-d{}s", time.count()), "--latency",
        "-s",  script};
    for (const std::string& header : headers) {
        arguments.emplace_back("-H");
        arguments.push_back(header);
    }
    arguments.push_back(server.address() + path);
    const double cpu_before = server.process.cpu_s();
    auto wrk = ChildProcess::start(std::move(arguments), scratch / "wrk", processor_of_load());
    if (!wrk) return pass_on(wrk);
    if (!wrk->wait()) return fail(ErrorCode::not_found, "wrk could not be run (package wrk)");
    const double cpu_s = server.process.cpu_s() - cpu_before;
    const std::string said = wrk->output();
    const std::size_t at = said.find("figures ");
    double requests = 0, bytes = 0, duration_us = 0, p50_us = 0, p99_us = 0;
    Load figures;
    if (at == std::string::npos ||
        std::sscanf(said.c_str() + at, "figures %lf %lf %lf %lf %lf %ld", &requests, &bytes,
                    &duration_us, &p50_us, &p99_us, &figures.failed) != 6)
        return fail(ErrorCode::internal, "wrk gave no figures of {}", path);
    const double seconds = duration_us / 1e6;
    figures.requests_per_s = requests / seconds;
    figures.mb_per_s = bytes / 1e6 / seconds;
    figures.p50_ms = p50_us / microseconds_in_a_millisecond;
    figures.p99_ms = p99_us / microseconds_in_a_millisecond;
    figures.cpu_cores = cpu_s / seconds;
    return figures;
}

}  // namespace stormcellar::bench
