// bench/process.h -- runs another program as a child, such as the stormcellard of the same build,
// and measures its CPU time and memory. The child is killed when this process ends for any reason.
//
// Threads   One thread at a time. The child is killed when the thread that started it ends
//           (PR_SET_PDEATHSIG).
#pragma once

#include <chrono>
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
    // Starts `arguments[0]`, which is looked up in $PATH if it has no slash. Its stdout goes to the
    // file `output`, its stderr to `output`.err. If `processor` is given, the child runs only on
    // that processor. Errors: io if the system cannot make a process. If the program cannot be run,
    // the child ends at once, so is_running() returns false.
    static Result<ChildProcess> start(std::vector<std::string> arguments,
                                      std::filesystem::path output,
                                      std::optional<int> processor = std::nullopt);
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&& other) noexcept;
    ~ChildProcess();  // kills the child if it still runs

    [[nodiscard]] bool is_running();
    // Waits for the child to end. Returns true if its exit status is 0.
    bool wait();
    // Sends SIGTERM to the child and waits for its end. Returns true if its exit status is 0.
    bool stop();
    [[nodiscard]] std::string output() const;  // its stdout so far

    [[nodiscard]] double cpu_s() const;  // of all threads of the child, since its start
    // Waits until the child has used no CPU time for a second, at most `most`. Returns false if the
    // child is still busy then, or has ended.
    bool wait_until_idle(std::chrono::seconds most);
    // Returns a line of the child's status (proc(5)) in MiB; "VmHWM" is its peak resident memory.
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
    double peak_mib = 0;  // peak resident memory since the last reset of the counter
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

    // Writes a configuration of the paths followed by `configuration`, and starts the daemon with
    // it. Returns when the daemon runs.
    [[nodiscard]] Status start(const std::string& configuration);
    // Sends SIGTERM to the daemon and waits. Returns true if its exit status is 0.
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
