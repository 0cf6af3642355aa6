// daemon/process/readiness.h -- whether the service has all that it needs, so that it may report
// READY.
//
// Whoever waits for READY (systemd, or a script that starts LDM next) relies on this: the drop
// directory can be read, state and cache can be written, and the status is served. Until then the
// service works as far as it can, reports what it waits for, and looks again every second. Thread
// contract: one thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/steady_time.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Fails if no file can be made in the directory. Removes the file again.
[[nodiscard]] Status can_write_in(FileSystem& files, const std::filesystem::path& directory);

class Readiness {
  public:
    // The first looks come sooner, for example because a thread has just begun to listen.
    static constexpr std::chrono::milliseconds first_wait{20}, longest_wait{1000};

    // Each check returns what is missing as its error.
    using Check = std::function<Status()>;
    void need(Check check) { checks_.push_back(std::move(check)); }

    [[nodiscard]] bool is_ready() const { return is_ready_; }
    // When to look again; none once nothing is missing.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // Returns true if it was time to look. Then it has run the checks, and missing() is the error
    // of the first check that failed.
    bool look(SteadyTime now);
    [[nodiscard]] const std::string& missing() const { return missing_; }
    // Returns true if missing() has changed since the last call; false at first, while what is
    // missing may still come at once.
    [[nodiscard]] bool is_news();

  private:
    std::vector<Check> checks_;
    bool is_ready_ = false;
    SteadyTime next_look_{};
    std::chrono::milliseconds wait_ = first_wait;
    std::string missing_, said_;
};

}  // namespace stormcellar::daemon
