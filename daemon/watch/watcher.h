// daemon/watch/watcher.h -- reports which files appear, change and vanish below the drop directory.
//
// Every directory has an inotify watch; new subdirectories get one when they appear. A directory is
// read after its watch is set, so that no file is missed. Call scan(), which reads the whole tree,
// at the start, after the event queue overflowed, and from time to time, because events can be lost
// (network file systems send none). Reporting a file twice does no harm, because the schedule has
// one entry for each path. Temporary names are never reported. Symbolic links, FIFOs, sockets and
// devices are reported only as left out. If some directories cannot be watched (no watches left, or
// file systems that report no changes), the watcher is blind, and the caller must scan more often.
//
// Threads   One thread at a time. The listener is called from within read_events() and scan().
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
#include "daemon/watch/unreadable.h"
#include "stormcellar/base/interface.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

class WatchListener : public Interface {
  public:
    // A file was closed after writing, or renamed to this name.
    virtual void file_closed(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // A file was created and is not closed yet, or a hard link was made, which is never closed.
    virtual void file_created(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // Returns true if file_grew() must report each write to the file before the file is closed.
    [[nodiscard]] virtual bool follows(const std::filesystem::path& /*path*/) const {
        return false;
    }
    virtual void file_grew(const std::filesystem::path& /*path*/, const FileStamp& /*stamp*/) {}
    // A directory was read, and has this file.
    virtual void file_found(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // A file was deleted or renamed away.
    virtual void file_gone(const std::filesystem::path& path) = 0;
    // A directory was deleted or renamed away, with everything in it.
    virtual void directory_gone(const std::filesystem::path& /*path*/, bool /*deleted*/) {}
    // An entry is neither file nor directory; `kind` says what it is, such as "a FIFO". Each scan
    // reports the entry again.
    virtual void entry_left_out(const std::filesystem::path& /*path*/, std::string_view /*kind*/) {}
    // Directories come or go faster than they can be read, so one was skipped. A scan is needed.
    virtual void directory_unread() {}
    // An entry could not be examined now, for example because descriptors have run out. The entry
    // is one that an event reported, or a directory of a scan. A scan is needed, but not at once.
    virtual void entry_unseen() {}
    // The kernel dropped events. A scan is needed.
    virtual void events_lost() = 0;
    // The drop directory itself was deleted or moved.
    virtual void drop_vanished() = 0;
    // A directory cannot be read, or some of its names are not used (`error.code` is permission or
    // io). Also called for the first directory that cannot be watched (no_space if the limit of
    // watches is reached), and for the first directory on a silent file system (unsupported).
    virtual void directory_problem(const Error& error) = 0;
};

class Watcher {
  public:
    // Both must outlive the watcher.
    Watcher(std::filesystem::path drop, EventSource& events, WatchListener& listener);

    // Sets a function that scan() and read_events() call now and then while they have much to do.
    // At each of these calls, scan() also reads events.
    void on_step(std::function<void()> step) { step_ = std::move(step); }
    // Watches the drop directory and all directories below it, and reports what they contain. Fails
    // if the drop directory cannot be read.
    [[nodiscard]] Status scan();
    // Handles the waiting events, but no more than one EventSource::read() returns.
    void read_events();
    [[nodiscard]] std::size_t directory_count() const { return watch_of_.size(); }
    // Returns the directories that could not be read in the last scan, or since then.
    [[nodiscard]] const Unreadable& unreadable() const { return unreadable_; }
    // Returns true if some directories change without events, as far as the last scan and later
    // events show.
    [[nodiscard]] bool is_blind() const { return unwatched_ > 0 || silent_ > 0; }

  private:
    void handle(const DirectoryEvent& event);
    void handle_directory(const DirectoryEvent& event, const std::filesystem::path& path);
    void handle_file(const DirectoryEvent& event, const std::filesystem::path& path);
    void forget_watch(int watch);
    void forget_unseen();
    void unwatch_tree(const std::filesystem::path& directory);
    void add_watch(const std::filesystem::path& directory);
    void report_problem(const std::filesystem::path& directory, const Error& problem);
    void look_for_silence(const std::filesystem::path& directory);
    [[nodiscard]] Status scan_below(const std::filesystem::path& directory);

    std::filesystem::path drop_;
    EventSource& events_;
    WatchListener& listener_;
    void step();
    std::function<void()> step_;
    bool is_reading_ = false;  // read_events() is running
    // The paths are text, which takes a quarter of the memory of std::filesystem::path.
    struct Watched {
        std::string path;
        std::uint64_t scan = 0;  // the last scan that saw the directory
    };
    std::unordered_map<int, Watched> path_of_;
    // sorted by path, so that everything below a directory is one range
    std::map<std::string, int> watch_of_;
    std::uint64_t scan_ = 0;
    bool saw_all_ = true;  // the current or last scan has seen every entry
    Unreadable unreadable_;
    using Clock = std::chrono::steady_clock;
    double owed_s_ = 0;  // debt at owed_at_; see most_owed_s
    Clock::time_point owed_at_{};
    std::size_t unwatched_ = 0, silent_ = 0;  // numbers of directories, in the last scan and since
    bool told_unwatched_ = false, told_silent_ = false;
};

}  // namespace stormcellar::daemon
