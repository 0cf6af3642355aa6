// daemon/queue/tried_files.h -- remembers which files were being ingested when the process ended.
//
// A file that kills the process (it takes all memory, or finds a fault) would do so again at each
// start, until systemd no longer starts the service. So a path is recorded before the file is
// opened, and removed when that has ended. After a start, the paths that are still recorded wait,
// longer after each consecutive end: 2 s, 8 s, 32 s and so on to 512 s. Files that ran together
// wait 10 s more, one after the other. After `most_ends` ends the file is not opened again until it
// has changed (its size or its time).
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

    // Returns how long each file must wait after the start. Files without an entry, and files that
    // were given up, need not wait.
    [[nodiscard]] std::map<std::filesystem::path, std::chrono::seconds> waits() const;
    // Returns true if the process ended too often while it ingested the file in this very state.
    [[nodiscard]] bool is_given_up(const std::filesystem::path& path, const FileStamp& stamp) const;

    // Call begin() and end() around ingesting the file.
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
