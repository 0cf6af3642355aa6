// daemon/watch/tree_walk.h -- the regular files below a directory.
//
// Walks by descriptors (openat, no symbolic link is followed), so a directory that is replaced by a
// link during the walk cannot lead it out of the tree. Files and directories with temporary names
// are left out (pipeline/drop/drop_names.h). The depth is bounded by max_walk_depth, and so is the
// length of paths, because each path takes memory in the queue, in the watcher and in the catalog.
// Thread contract: functions without state; they call the visitor from the calling thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "daemon/watch/file_stamp.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

inline constexpr int max_walk_depth = 16;
inline constexpr std::size_t most_path_bytes = 1024;  // paths must be shorter
inline constexpr int entries_a_step = 128;

struct WalkVisitor {
    // Called before the directory's entries are read, so that a watch that is set here misses
    // nothing.
    std::function<void(const std::filesystem::path&)> directory;
    std::function<void(const std::filesystem::path&, const FileStamp&)> file;
    // A directory below the root that cannot be read, or is too deep; one line. The walk goes on.
    std::function<void(const std::string&)> problem;
    // An entry that is neither file nor directory: a link, a FIFO, a device. May be empty.
    std::function<void(const std::filesystem::path&, mode_t mode)> other = {};
    // Called beside `problem` if the system has no descriptors or memory for it now. May be empty.
    std::function<void()> unseen = {};
    // Called after this many entries, so that the caller can do other work meanwhile. May be empty.
    std::function<void()> step = {};
};

// Fails (not_found, permission, io) if the root itself cannot be read. `depth` is the depth of the
// root below the directory from which depth counts; a root of depth 0 may itself be a link.
[[nodiscard]] Status walk(const std::filesystem::path& root, const WalkVisitor& visitor,
                          int depth = 0);

}  // namespace stormcellar::daemon
