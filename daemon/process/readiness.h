// daemon/process/readiness.h -- whether the service has all that it needs, so that READY may be
// said.
//
// Whoever waits for READY (systemd, a script that starts LDM next) relies on it: the drop directory
// can be read, state and cache can be written, and the status is answered. Until then the service
// works as far as it can, says what it waits for, and looks again every second.
// Thread contract: one thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/steady_time.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Whether a file can be made in the directory; it is removed again.
[[nodiscard]] Status can_write_in(FileSystem& files, const std::filesystem::path& directory);

class Readiness {
  public:
    // Sooner at first, as when a thread has just begun to listen.
    static constexpr std::chrono::milliseconds first_wait{20}, longest_wait{1000};

    // Each says what is missing, or nothing.
    using Check = std::function<Status()>;
    void need(Check check) { checks_.push_back(std::move(check)); }

    [[nodiscard]] bool is_ready() const { return is_ready_; }
    // When to look again; none once all is there.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // True when it is time to look. Asks each check; the first one that says something is
    // missing().
    bool look(SteadyTime now);
    [[nodiscard]] const std::string& missing() const { return missing_; }
    // Whether missing() has changed since the last call; not while it may yet come at once.
    [[nodiscard]] bool is_news();

  private:
    std::vector<Check> checks_;
    bool is_ready_ = false;
    SteadyTime next_look_{};
    std::chrono::milliseconds wait_ = first_wait;
    std::string missing_, said_;
};

}  // namespace stormcellar::daemon
