// daemon/watch/watcher.h -- says which files appear, change and go below the drop directory.
//
// inotify watches on every directory, sub-directories as they appear; a directory is read after its
// watch is set, so what was put into it in between is found. scan() reads the whole tree: at the
// start, after the event queue overflowed, and from time to time for ever, since events can be
// lost (network file systems have none). What is said twice does no harm: the schedule has one
// entry a path. Temporary names are never reported; symbolic links, FIFOs, sockets and devices only
// as left out. Where not all can be watched (no watches left, file systems whose changes are not
// told) it is blind, and must be scanned more often.
// Thread contract: one thread; the listener is called from within read_events() and scan().
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

    // Closed after writing, or renamed to this name.
    virtual void file_closed(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // Made here and not closed yet; or a hard link, for which no close ever comes.
    virtual void file_created(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // Whether to tell of each write to the file, before it is closed.
    [[nodiscard]] virtual bool follows(const std::filesystem::path& /*path*/) const {
        return false;
    }
    virtual void file_grew(const std::filesystem::path& /*path*/, const FileStamp& /*stamp*/) {}
    // Stands in a directory that was read.
    virtual void file_found(const std::filesystem::path& path, const FileStamp& stamp) = 0;
    // Deleted, or renamed away.
    virtual void file_gone(const std::filesystem::path& path) = 0;
    // The same of a directory, with all that it held.
    virtual void directory_gone(const std::filesystem::path& /*path*/, bool /*deleted*/) {}
    // Neither file nor directory: `kind` says what ("a FIFO"). Said again by each scan.
    virtual void entry_left_out(const std::filesystem::path& /*path*/, std::string_view /*kind*/) {}
    // Directories come or go faster than they can be read: this one was left to a scan, which is
    // needed.
    virtual void directory_unread() {}
    // What an event told of, or a directory of a scan, could not be looked at now, as when
    // descriptors run out; a scan is needed, and there is no use in one at once.
    virtual void entry_unseen() {}
    // The kernel dropped events; a scan is needed.
    virtual void events_lost() = 0;
    // The drop directory itself was deleted or moved.
    virtual void drop_vanished() = 0;
    // A directory that cannot be read; or the first of those that cannot be watched, because the
    // limit is reached (`error.code` no_space) or because its file system is silent (unsupported).
    virtual void directory_problem(const Error& error) = 0;
};

class Watcher {
  public:
    // Both must outlive the watcher.
    Watcher(std::filesystem::path drop, EventSource& events, WatchListener& listener);

    // Called now and then from within scan() and read_events(), while there is much to do. In a
    // scan events are read then as well.
    void on_step(std::function<void()> step) { step_ = std::move(step); }
    // Watches and reports everything below the drop directory; fails when it cannot be read.
    [[nodiscard]] Status scan();
    // Handles what waits at events.descriptor().
    void read_events();
    [[nodiscard]] std::size_t directory_count() const { return watch_of_.size(); }
    // Some directories' changes come without events, as the last scan and what came since have it.
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
    bool is_reading_ = false;  // events
    // Paths as text, which takes a quarter of the memory.
    struct Watched {
        std::string path;
        std::uint64_t scan = 0;  // that saw it last
    };
    std::unordered_map<int, Watched> path_of_;
    std::map<std::string, int> watch_of_;  // sorted: what lies below a directory is one run
    std::uint64_t scan_ = 0;
    bool saw_all_ = true;  // that scan
    using Clock = std::chrono::steady_clock;
    double owed_s_ = 0;  // see most_owed_s, at owed_at_
    Clock::time_point owed_at_{};
    std::size_t unwatched_ = 0, silent_ = 0;  // directories, of the last scan and since
    bool told_unwatched_ = false, told_silent_ = false;
};

}  // namespace stormcellar::daemon
