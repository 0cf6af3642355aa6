// daemon/status/status_file.h -- publishes the status: state/status.json and the manager's status
// line.
//
// At most once a second, and only when something has changed. The file appears by rename, so a
// reader always sees a whole document; it is not synced, since after a crash it means nothing.
// Thread contract: one thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/process/notify.h"
#include "daemon/status/status.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::daemon {

class StatusFile {
  public:
    StatusFile(FileSystem& file_system, const std::filesystem::path& state, Notifier& notifier);

    void changed() { changed_ = true; }
    // Writes when something has changed and a second has passed, or at once if forced. Returns true
    // if it was time to write.
    bool publish(const StatusBook& book, const Pending& pending, SteadyTime now, bool force);
    [[nodiscard]] std::optional<SteadyTime> next_time() const;

  private:
    Status write(const std::string& text);

    FileSystem& file_system_;
    std::filesystem::path path_, temporary_;
    Notifier& notifier_;
    bool changed_ = false;
    bool failing_ = false;  // logged once, until writing works again
    SteadyTime next_{};
};

}  // namespace stormcellar::daemon
