// tests/fault/faulty_daemon.h -- the real stormcellard, configured to be quick, and what it must
// leave behind.
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

// Built with a sanitizer, which has to be loaded first and takes memory of its own.
#if defined(STORMCELLAR_SANITIZED)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

// The number in the environment, or what is usual: `STORMCELLAR_KILLS=1000`.
[[nodiscard]] int number_of(const char* variable, int usual);

class FaultyDaemon {
  public:
    // Removes the status of the run before, so that what status() says is this run's. `more` goes
    // on in [ingest].
    void start(const std::map<std::string, std::string>& environment = {},
               const std::string& more = {});
    void kill();  // with SIGKILL
    [[nodiscard]] int stop() { return running_.terminate(); }
    [[nodiscard]] pid_t id() const;

    [[nodiscard]] Places places() const {
        return {running_.drop(), running_.root() / "state", running_.cache()};
    }
    [[nodiscard]] const std::filesystem::path drop() const { return running_.drop(); }
    // Waits until so many files are settled in the catalog and nothing is pending; false when that
    // does not come true within `seconds`.
    [[nodiscard]] bool catches_up(std::size_t files, int seconds = 60) const;
    // Rows of the catalog that are complete, partial, rejected or gone.
    [[nodiscard]] std::size_t settled() const;
    [[nodiscard]] daemon::RunningDaemon& running() { return running_; }
    // The end of the log, for messages.
    [[nodiscard]] std::string log_end() const;

  private:
    daemon::RunningDaemon running_;
};

[[nodiscard]] std::size_t files_of(const std::vector<Delivered>& delivered);

}  // namespace stormcellar::fault
