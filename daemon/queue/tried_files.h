// daemon/queue/tried_files.h -- which files were being ingested when the process ended.
//
// A file that kills the process (it takes all memory, or finds a fault) would be met again at each
// start, until systemd starts the service no more. So a path is written down before the file is
// opened, and taken out when that has ended. After a start, the paths that are still there wait for
// others, longer after each time in a row: 2 s, 8 s, 32 s and so on to 512 s. Files that ran
// together wait 10 s more, one after the other. After `most_ends` times the file is not opened
// again until it is another one (its size or its time has changed).
//
// The list need not survive a power cut, so no write waits for the disk. Each ingested file costs
// two writes of some hundred bytes. If the list is missing, no file is held back.
//
// Threads   Any thread may call every function.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>

#include "daemon/watch/file_stamp.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {

class TriedFiles {
  public:
    static constexpr int most_ends = 6;
    static constexpr std::size_t most_remembered = 64;

    // Reads what the last process left. A file that cannot be written is as good as none.
    explicit TriedFiles(const std::filesystem::path& file);

    // Returns how long each file must wait after the start. A file without an entry need not wait,
    // and neither need one that is given up.
    [[nodiscard]] std::map<std::filesystem::path, std::chrono::seconds> waits() const;
    // Returns true if the process ended so often while it had this very file.
    [[nodiscard]] bool is_given_up(const std::filesystem::path& path, const FileStamp& stamp) const;

    // Between the two, the file is being ingested.
    void begin(const std::filesystem::path& path, const FileStamp& stamp);
    void end(const std::filesystem::path& path);

  private:
    struct Tried {
        FileStamp stamp;
        int ends = 0;  // of the process, in a row
        bool is_running = false;
    };
    void read(const std::string& text) STORMCELLAR_REQUIRES(mutex_);
    void write() STORMCELLAR_REQUIRES(mutex_);

    mutable Mutex mutex_;
    Descriptor file_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, Tried> tried_ STORMCELLAR_GUARDED_BY(mutex_);  // by path
};

}  // namespace stormcellar::daemon
