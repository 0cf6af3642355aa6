// daemon/watch/tree_walk.h -- finds the regular files below a directory.
//
// The walk uses descriptors (openat) and follows no symbolic link. So a directory that is replaced
// by a link during the walk cannot lead the walk out of the tree. Files and directories with
// temporary names are left out (pipeline/drop/drop_names.h). max_walk_depth limits the depth.
// most_path_bytes limits the length of paths, because each path takes memory in the queue, the
// watcher and the catalog.
//
// Threads   Any thread; the callbacks are called from within walk().
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "daemon/watch/file_stamp.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

inline constexpr int max_walk_depth = 16;
inline constexpr std::size_t most_path_bytes = 1024;  // a path must be shorter
inline constexpr int entries_a_step = 128;

struct WalkVisitor {
    // Called before the entries of the directory are read. If this call sets a watch, no later
    // entry is missed.
    std::function<void(const std::filesystem::path&)> directory;
    std::function<void(const std::filesystem::path&, const FileStamp&)> file;
    // Reports a directory that cannot be read or is too deep (unsupported). Also reports the first
    // reason why names in a directory are not used (unsupported: a name is too long; other codes:
    // an entry cannot be examined). The message is one line that names the directory. The walk goes
    // on.
    std::function<void(const std::filesystem::path&, const Error&)> problem;
    // Reports an entry that is neither file nor directory, such as a link, a FIFO or a device. May
    // be empty.
    std::function<void(const std::filesystem::path&, mode_t mode)> other = {};
    // Called in addition to `problem` if a directory cannot be read because the system has no
    // descriptors or memory left. May be empty.
    std::function<void()> unseen = {};
    // Called after every entries_a_step entries, so that the caller can do other things meanwhile.
    // May be empty.
    std::function<void()> step = {};
};

// Walks a tree. `depth` is how deep `root` is below the drop directory; it counts toward
// max_walk_depth. A root of depth 0 may be a link. A root that is too deep is reported to `problem`
// and not walked. Errors: not_found, permission or io if the root cannot be read; io also if the
// root was deleted and only a mount keeps it, so that nothing will ever appear in it.
[[nodiscard]] Status walk(const std::filesystem::path& root, const WalkVisitor& visitor,
                          int depth = 0);

}  // namespace stormcellar::daemon
