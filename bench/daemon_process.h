// bench/daemon_process.h -- runs the stormcellard built with the benchmarks as a child, and
// measures what it uses. It is killed when this process ends, however that happens.
//
// Threads   One thread, which must live as long as the daemon is to run (PR_SET_PDEATHSIG follows
//           it).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct DaemonStatus {
    std::string state;
    std::size_t waiting = 0, running = 0, growing = 0;
    std::uint64_t cache_bytes = 0, grids = 0, failures = 0, overflows = 0;
    double latency_median_s = 0, latency_p95_s = 0;  // as the daemon reports it
};

struct DaemonMemory {
    double peak_mib = 0;  // resident, since the last reset
    double anonymous_mib = 0, file_mib = 0;
};

class DaemonProcess {
  public:
    // Uses ROOT/drop, ROOT/state, ROOT/cache, ROOT/stormcellard.toml and ROOT/log.
    explicit DaemonProcess(std::filesystem::path root);
    DaemonProcess(std::filesystem::path root, std::filesystem::path program)
        : root_(std::move(root)), program_(std::move(program)) {}
    DaemonProcess(const DaemonProcess&) = delete;
    DaemonProcess& operator=(const DaemonProcess&) = delete;
    ~DaemonProcess();  // kills the daemon if it still runs

    [[nodiscard]] std::filesystem::path drop() const { return root_ / "drop"; }
    [[nodiscard]] std::filesystem::path cache() const { return root_ / "cache"; }
    [[nodiscard]] std::filesystem::path catalog() const { return root_ / "state/catalog"; }

    // Starts the daemon with `configuration` after the paths in its configuration. Returns when it
    // runs.
    [[nodiscard]] Status start(const std::string& configuration);
    // Asks the daemon to end and waits. Returns true if it ended with success.
    [[nodiscard]] bool stop();
    [[nodiscard]] bool is_running();
    [[nodiscard]] pid_t id() const { return child_; }  // 0: none

    [[nodiscard]] DaemonStatus status() const;  // from status.json
    [[nodiscard]] double cpu_s() const;
    [[nodiscard]] DaemonMemory memory() const;
    void reset_peak() const;

  private:
    std::filesystem::path root_, program_;
    pid_t child_ = 0;
};

}  // namespace stormcellar::bench
