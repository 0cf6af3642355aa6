// daemon/queue/tried_files.h -- remembers which files were being ingested when the process ended.
//
// A file may kill the process, because it takes all memory or triggers a fault. It would kill the
// new process after each start, until systemd no longer starts the service. So a path is recorded
// before its file is opened, and removed when the file has been processed. After a start, the files
// that are still recorded wait: 2 s after the process has ended once, then 8 s, 32 s and so on up
// to 512 s. Among files with the same number of ends, each waits 10 s longer than the file before
// it. After `most_ends` ends, a file is not opened again until its size or its time has changed.
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

    // Reads the list that the last process wrote. If the list's file cannot be written, nothing is
    // recorded.
    explicit TriedFiles(const std::filesystem::path& file);

    // Returns how long files must wait after the start. Files that are not in the result, such as
    // files that were given up, need not wait.
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
        int ends = 0;  // how often the process ended, in a row
        bool is_running = false;
    };
    void read(const std::string& text) STORMCELLAR_REQUIRES(mutex_);
    void write() STORMCELLAR_REQUIRES(mutex_);

    mutable Mutex mutex_;
    Descriptor file_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, Tried> tried_ STORMCELLAR_GUARDED_BY(mutex_);  // by path
};

}  // namespace stormcellar::daemon
