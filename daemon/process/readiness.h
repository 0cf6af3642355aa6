// daemon/process/readiness.h -- whether the service has everything that it needs, so that it may
// report READY.
//
// Programs that wait for READY (systemd, or a script that starts LDM next) rely on this: the state
// and the cache can be written, and the status is served. Until then the service works as far as it
// can, reports what it waits for, and checks again every second. The drop directory belongs to LDM:
// it may appear late, and nothing else on the machine waits for it.
//
// Threads   One thread at a time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/steady_time.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Returns ok if a file can be made in the directory; the file is removed again.
[[nodiscard]] Status can_write_in(FileSystem& files, const std::filesystem::path& directory);

class Readiness {
  public:
    // Waits are shorter at first, for example for a thread that has just begun to listen.
    static constexpr std::chrono::milliseconds first_wait{20}, longest_wait{1000};

    // Returns an error that says what is missing, or ok.
    using Check = std::function<Status()>;
    void need(Check check) { checks_.push_back(std::move(check)); }

    [[nodiscard]] bool is_ready() const { return is_ready_; }
    // Returns when to check again; none once everything is there.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // Returns true if it was time to check. Calls each check; the first error becomes missing().
    bool look(SteadyTime now);
    [[nodiscard]] const std::string& missing() const { return missing_; }
    // Returns true if missing() has changed since the last call, but not while the waits are still
    // short and it may be resolved at once.
    [[nodiscard]] bool is_news();

  private:
    std::vector<Check> checks_;
    bool is_ready_ = false;
    SteadyTime next_look_{};
    std::chrono::milliseconds wait_ = first_wait;
    std::string missing_, said_;
};

}  // namespace stormcellar::daemon
