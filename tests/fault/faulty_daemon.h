// tests/fault/faulty_daemon.h -- the real stormcellard, configured to be quick, with checks of its
// state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/daemon/running_daemon.h"
#include "tests/fault/aftermath.h"

namespace stormcellar::fault {

// True for a build with a sanitizer, whose library must be loaded first and takes memory of its
// own.
#if defined(STORMCELLAR_SANITIZED)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

// Returns the number in an environment variable such as STORMCELLAR_KILLS, or `usual` if it is not
// set.
[[nodiscard]] int number_of(const char* variable, int usual);

class FaultyDaemon {
  public:
    // Starts the daemon. Removes the status of the previous run first, so that status() returns
    // this run's status. `more` is added to [ingest].
    void start(const std::map<std::string, std::string>& environment = {},
               const std::string& more = {});
    void kill();  // with SIGKILL
    [[nodiscard]] int stop() { return running_.terminate(); }
    [[nodiscard]] pid_t id() const;

    [[nodiscard]] Places places() const {
        return {running_.drop(), running_.root() / "state", running_.cache()};
    }
    [[nodiscard]] const std::filesystem::path drop() const { return running_.drop(); }
    // Waits until this many files are settled in the catalog and nothing is pending. Returns false
    // if that takes longer than `seconds`.
    [[nodiscard]] bool catches_up(std::size_t files, int seconds = 60) const;
    // Returns the number of rows of the catalog that are complete, partial, rejected or gone.
    [[nodiscard]] std::size_t settled() const;
    [[nodiscard]] daemon::RunningDaemon& running() { return running_; }
    // Returns the end of the log, for messages.
    [[nodiscard]] std::string log_end() const;

  private:
    daemon::RunningDaemon running_;
};

[[nodiscard]] std::size_t files_of(const std::vector<Delivered>& delivered);

}  // namespace stormcellar::fault
