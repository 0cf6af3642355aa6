// daemon/process/readiness.h -- checks that the service has everything it needs to report READY.
//
// READY means that the state and the cache can be written, and that the status is served. Programs
// that wait for READY (systemd, or a script that then starts LDM) rely on this. Until then the
// service works as far as it can, reports what is missing, and checks again every second. READY
// does not wait for the drop directory, which belongs to LDM and may appear late.
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

// Makes a file in the directory and removes it again. Returns the first error.
[[nodiscard]] Status can_write_in(FileSystem& files, const std::filesystem::path& directory);

class Readiness {
  public:
    // Times between checks. The first times are short, because a failed check may succeed soon: for
    // example, a thread may be about to listen.
    static constexpr std::chrono::milliseconds first_wait{20}, longest_wait{1000};

    // Returns ok, or an error that says what is missing.
    using Check = std::function<Status()>;
    void need(Check check) { checks_.push_back(std::move(check)); }

    [[nodiscard]] bool is_ready() const { return is_ready_; }
    // Returns when to check again; none once everything is there.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // If a check is due, calls the checks until one fails, and returns true. missing() then returns
    // the message of the failed check. If no check is due, returns false.
    bool look(SteadyTime now);
    [[nodiscard]] const std::string& missing() const { return missing_; }
    // Returns true if missing() has changed since this function last returned true. Returns false
    // while the times between checks are still short, because the problem may be over at once.
    [[nodiscard]] bool is_news();

  private:
    std::vector<Check> checks_;
    bool is_ready_ = false;
    SteadyTime next_look_{};
    std::chrono::milliseconds wait_ = first_wait;
    std::string missing_, said_;
};

}  // namespace stormcellar::daemon
