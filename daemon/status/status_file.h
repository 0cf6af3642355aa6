// daemon/status/status_file.h -- publishes a status in the file status.json and in the status line
// of the service manager.
//
// The status is written at most once a second, and only if something has changed. The file appears
// by rename, so that a reader always sees a complete document. The file is not synced, because a
// status has no meaning after a crash.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/steady_time.h"
#include "service/notify.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::daemon {

class StatusFile {
  public:
    // Makes an object that writes status.json into `directory`.
    StatusFile(FileSystem& file_system, const std::filesystem::path& directory, Notifier& notifier);

    struct Texts {
        std::string line;  // for the service manager
        std::string json;
    };

    void changed() { changed_ = true; }
    // If something has changed and a second has passed, or if `force` is set, calls `make`,
    // publishes its texts and returns true. Otherwise returns false.
    bool publish(const std::function<Texts()>& make, SteadyTime now, bool force);
    [[nodiscard]] std::optional<SteadyTime> next_time() const;

  private:
    Status write(const std::string& text);

    FileSystem& file_system_;
    std::filesystem::path path_, temporary_;
    Notifier& notifier_;
    bool changed_ = false;
    bool failing_ = false;  // the last write failed, and that was logged
    SteadyTime next_{};
};

}  // namespace stormcellar::daemon
