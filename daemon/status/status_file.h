// daemon/status/status_file.h -- publishes a status in a status.json and in the status line of the
// service manager.
//
// It is written at most once a second, and only if something has changed. The file appears by
// rename, so that a reader always sees a complete document. It is not synced, since it means
// nothing after a crash.
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
    // `directory` is where status.json is written.
    StatusFile(FileSystem& file_system, const std::filesystem::path& directory, Notifier& notifier);

    struct Texts {
        std::string line;  // for the service manager
        std::string json;
    };

    void changed() { changed_ = true; }
    // Writes if something has changed and a second has passed, or at once if forced. Returns
    // whether it was time to write; `make` is called only then.
    bool publish(const std::function<Texts()>& make, SteadyTime now, bool force);
    [[nodiscard]] std::optional<SteadyTime> next_time() const;

  private:
    Status write(const std::string& text);

    FileSystem& file_system_;
    std::filesystem::path path_, temporary_;
    Notifier& notifier_;
    bool changed_ = false;
    bool failing_ = false;  // logged once, until it works again
    SteadyTime next_{};
};

}  // namespace stormcellar::daemon
