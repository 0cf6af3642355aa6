// daemon/watch/watcher.h -- reports which files appear, change and go below the drop directory.
//
// It sets inotify watches on every directory, and on subdirectories as they appear. It reads a
// directory after setting its watch, so it finds files that came in between. scan() reads the whole
// tree: at the start, after the event queue overflowed, and from time to time, because events can
// be lost (network file systems have none). Reporting a file twice does no harm: the schedule has
// one entry for each path. Temporary names are never reported; symbolic links, FIFOs, sockets and
// devices are reported only as left out. If not everything can be watched (no watches left, or file
// systems whose changes are not reported), the watcher is blind, and the caller must scan more
// often. Thread contract: one thread; read_events() and scan() call the listener.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>

#include "daemon/watch/file_stamp.h"
#include "daemon/watch/inotify.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

class WatchListener {
  public:
    WatchListener() = default;
    WatchListener(const WatchListener&) = delete;
    WatchListener& operator=(const WatchListener&) = delete;
    virtual ~WatchListener() = default;

    // The file was closed after writing, or renamed to this name.
    virtual void file_closed(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // The file was created and not closed yet; or it is a hard link, for which no close ever comes.
    virtual void file_created(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // Whether to report each write to the file before it is closed.
    [[nodiscard]] virtual bool follows(const std::filesystem::path& /*path*/) const {
        return false;
    }
    virtual void file_grew(const std::filesystem::path& /*path*/, const FileStamp& /*stamp*/) {}
    // The file is in a directory that was read.
    virtual void file_found(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // The file was deleted, or renamed to another place.
    virtual void file_gone(const std::filesystem::path& path) = 0;
    // The same for a directory, with everything in it.
    virtual void directory_gone(const std::filesystem::path& /*path*/, bool /*deleted*/) {}
    // An entry that is neither file nor directory: `kind` says what ("a FIFO"). Each scan reports
    // it again.
    virtual void entry_left_out(const std::filesystem::path& /*path*/, std::string_view /*kind*/) {}
    // Directories come or go faster than they can be read: this one was left to a scan, which is
    // needed.
    virtual void directory_unread() {}
    // What an event reported, or a directory of a scan, could not be examined now, for example for
    // want of descriptors. A scan is needed, but not at once, because that would be in vain.
    virtual void entry_unseen() {}
    // The kernel dropped events; a scan is needed.
    virtual void events_lost() = 0;
    // The drop directory itself was deleted or moved.
    virtual void drop_vanished() = 0;
    // A directory that cannot be read; or the first directory that cannot be watched, because the
    // limit is reached (`error.code` no_space) or because its file system is silent (unsupported).
    virtual void directory_problem(const Error& error) = 0;
};

class Watcher {
  public:
    // Both must outlive the watcher.
    Watcher(std::filesystem::path drop, EventSource& events, WatchListener& listener);

    // Called now and then during scan() and read_events(), while there is much to do. During a scan
    // events are read as well.
    void on_step(std::function<void()> step) { step_ = std::move(step); }
    // Watches and reports everything below the drop directory; fails if the directory cannot be
    // read.
    [[nodiscard]] Status scan();
    // Handles the events that wait at events.descriptor().
    void read_events();
    [[nodiscard]] std::size_t directory_count() const { return watch_of_.size(); }
    // Returns true if changes in some directories come without events, by the last scan and the
    // events since.
    [[nodiscard]] bool is_blind() const { return unwatched_ > 0 || silent_ > 0; }

  private:
    void handle(const DirectoryEvent& event);
    void handle_directory(const DirectoryEvent& event, const std::filesystem::path& path);
    void handle_file(const DirectoryEvent& event, const std::filesystem::path& path);
    void forget_watch(int watch);
    void forget_unseen();
    void unwatch_tree(const std::filesystem::path& directory);
    void add_watch(const std::filesystem::path& directory);
    void look_for_silence(const std::filesystem::path& directory);
    [[nodiscard]] Status scan_below(const std::filesystem::path& directory);

    std::filesystem::path drop_;
    EventSource& events_;
    WatchListener& listener_;
    void step();
    std::function<void()> step_;
    bool is_reading_ = false;  // it is reading events
    // Holds paths as text, which takes a quarter of the memory.
    struct Watched {
        std::string path;
        std::uint64_t scan = 0;  // the scan that last found the directory
    };
    std::unordered_map<int, Watched> path_of_;
    std::map<std::string, int>
        watch_of_;  // sorted: everything below a directory is one contiguous run
    std::uint64_t scan_ = 0;
    bool saw_all_ = true;  // the last scan did
    using Clock = std::chrono::steady_clock;
    double owed_s_ = 0;  // see most_owed_s; as of owed_at_
    Clock::time_point owed_at_{};
    std::size_t unwatched_ = 0, silent_ = 0;  // directories, from the last scan and since
    bool told_unwatched_ = false, told_silent_ = false;
};

}  // namespace stormcellar::daemon
