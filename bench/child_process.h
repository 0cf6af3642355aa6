// bench/child_process.h -- runs another program as a child and measures what it uses. The child is
// killed when this process ends, however that happens.
//
// Threads   One thread, which must live as long as the child is to run (PR_SET_PDEATHSIG follows
//           it).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

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

    [[nodiscard]] double cpu_s() const;     // of all of its threads, since its start
    [[nodiscard]] double peak_mib() const;  // resident, since its start
    [[nodiscard]] pid_t id() const { return child_; }

  private:
    ChildProcess(pid_t child, std::filesystem::path output)
        : child_(child), output_(std::move(output)) {}
    pid_t child_ = 0;  // 0: none
    std::filesystem::path output_;
};

}  // namespace stormcellar::bench
