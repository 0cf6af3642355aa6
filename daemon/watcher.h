// daemon/watcher.h -- says which files appear, change and go below the drop directory.
//
// inotify watches on every directory, sub-directories as they appear; a directory is read after its
// watch is set, so what was put into it in between is found. scan() reads the whole tree: at the
// start, after the event queue overflowed, and from time to time for ever, since events can be
// lost (network file systems have none). What is said twice does no harm: the schedule has one
// entry a path. Symbolic links, devices, FIFOs and temporary names are never reported.
// Thread contract: one thread; the listener is called from within read_events() and scan().
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>

#include "base/result.h"
#include "daemon/file_stamp.h"
#include "daemon/inotify.h"

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
    // The kernel dropped events; a scan is needed.
    virtual void events_lost() = 0;
    // The drop directory itself was deleted or moved.
    virtual void drop_vanished() = 0;
    // A directory that cannot be watched because the limit is reached (`error.code` no_space), or
    // that cannot be read.
    virtual void directory_problem(const Error& error) = 0;
};

class Watcher {
  public:
    // Both must outlive the watcher.
    Watcher(std::filesystem::path drop, EventSource& events, WatchListener& listener);

    // Watches and reports everything below the drop directory; fails when it cannot be read.
    [[nodiscard]] Status scan();
    // Handles what waits at events.descriptor().
    void read_events();
    [[nodiscard]] std::size_t directory_count() const { return watch_of_.size(); }

  private:
    void handle(const DirectoryEvent& event);
    void handle_directory(const DirectoryEvent& event, const std::filesystem::path& path);
    void handle_file(const DirectoryEvent& event, const std::filesystem::path& path);
    void forget_watch(int watch);
    void unwatch_tree(const std::filesystem::path& directory);
    void add_watch(const std::filesystem::path& directory);
    [[nodiscard]] Status scan_below(const std::filesystem::path& directory);

    std::filesystem::path drop_;
    EventSource& events_;
    WatchListener& listener_;
    std::unordered_map<int, std::filesystem::path> path_of_;
    std::map<std::filesystem::path, int> watch_of_;  // sorted: a tree is one run of entries
};

}  // namespace stormcellar::daemon
