// daemon/queue/tried_files.h -- remembers which files were being ingested when the process ended.
//
// A file that kills the process (it takes all memory, or triggers a fault) would do so again at
// each start, until systemd no longer starts the service. So a path is recorded before its file is
// opened, and removed when the file has been processed. After a start, files that are still
// recorded wait: 2 s after the first end of the process, then 8 s, 32 s and so on to 512 s. Among
// files with equally many ends, each waits 10 s longer than the file before it. After `most_ends`
// ends a file is not opened again until its size or its time has changed.
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

    // Reads the list of the last process. If the file cannot be written, the list has no effect.
    explicit TriedFiles(const std::filesystem::path& file);

    // Returns how long each file must wait after the start. Files that are missing in the result,
    // including files that were given up, need not wait.
    [[nodiscard]] std::map<std::filesystem::path, std::chrono::seconds> waits() const;
    // Returns true if the process ended `most_ends` times while it ingested the file, and the file
    // has not changed since.
    [[nodiscard]] bool is_given_up(const std::filesystem::path& path, const FileStamp& stamp) const;

    // Call begin() before ingesting the file, and end() after it.
    void begin(const std::filesystem::path& path, const FileStamp& stamp);
    void end(const std::filesystem::path& path);

  private:
    struct Tried {
        FileStamp stamp;
        int ends = 0;  // consecutive ends of the process
        bool is_running = false;
    };
    void read(const std::string& text) STORMCELLAR_REQUIRES(mutex_);
    void write() STORMCELLAR_REQUIRES(mutex_);

    mutable Mutex mutex_;
    Descriptor file_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, Tried> tried_ STORMCELLAR_GUARDED_BY(mutex_);  // by path
};

}  // namespace stormcellar::daemon
