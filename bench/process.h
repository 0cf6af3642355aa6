// bench/process.h -- runs another program as a child, among them the stormcellard built with the
// benchmarks, and measures what it uses. The child is killed when this process ends, however that
// happens.
//
// Threads   One thread, which must live as long as the child is to run (PR_SET_PDEATHSIG follows
//           it).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

// Returns the contents of a file; empty if it cannot be read.
[[nodiscard]] std::string text_in(const std::filesystem::path& file);

class ChildProcess {
  public:
    // Starts `arguments[0]`, which is looked for in $PATH if it has no slash. `output` gets what it
    // writes on stdout, `output`.err what it writes on stderr. It runs on this processor alone if
    // one is named. Errors: io if there is no process to be had; what the program itself lacks
    // shows in is_running().
    static Result<ChildProcess> start(std::vector<std::string> arguments,
                                      std::filesystem::path output,
                                      std::optional<int> processor = std::nullopt);
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&& other) noexcept;
    ~ChildProcess();  // kills it if it still runs

    [[nodiscard]] bool is_running();
    // Waits for its end. Returns true if it ended with success.
    bool wait();
    // Asks it to end with SIGTERM, and waits.
    bool stop();
    [[nodiscard]] std::string output() const;  // what it has written so far

    [[nodiscard]] double cpu_s() const;  // of all of its threads, since its start
    // Returns a line of its status (proc(5)) in MiB: "VmHWM", its peak resident memory.
    [[nodiscard]] double memory_mib(std::string_view line = "VmHWM") const;
    [[nodiscard]] pid_t id() const { return child_; }

  private:
    ChildProcess(pid_t child, std::filesystem::path output)
        : child_(child), output_(std::move(output)) {}
    pid_t child_ = 0;  // 0: none
    std::filesystem::path output_;
};

struct DaemonStatus {
    std::string state;
    std::size_t waiting = 0, running = 0;
    std::uint64_t cache_bytes = 0, failures = 0, overflows = 0;
};

struct DaemonMemory {
    double peak_mib = 0;  // resident, since the last reset
    double anonymous_mib = 0, file_mib = 0;
};

class DaemonProcess {
  public:
    // Uses ROOT/drop, ROOT/state, ROOT/cache, ROOT/stormcellard.toml and ROOT/log.err.
    explicit DaemonProcess(std::filesystem::path root);
    DaemonProcess(std::filesystem::path root, std::filesystem::path program)
        : root_(std::move(root)), program_(std::move(program)) {}

    [[nodiscard]] std::filesystem::path drop() const { return root_ / "drop"; }
    [[nodiscard]] std::filesystem::path cache() const { return root_ / "cache"; }
    [[nodiscard]] std::filesystem::path catalog() const { return root_ / "state/catalog"; }

    // Starts the daemon with `configuration` after the paths in its configuration. Returns when it
    // runs.
    [[nodiscard]] Status start(const std::string& configuration);
    // Asks the daemon to end and waits. Returns true if it ended with success.
    [[nodiscard]] bool stop() { return child_ && child_->stop(); }
    [[nodiscard]] bool is_running() { return child_ && child_->is_running(); }
    [[nodiscard]] pid_t id() const { return child_ ? child_->id() : 0; }  // 0: none

    [[nodiscard]] DaemonStatus status() const;  // from status.json
    [[nodiscard]] double cpu_s() const { return child_->cpu_s(); }
    [[nodiscard]] DaemonMemory memory() const;
    void reset_peak() const;

  private:
    std::filesystem::path root_, program_;
    std::optional<ChildProcess> child_;
};

}  // namespace stormcellar::bench
