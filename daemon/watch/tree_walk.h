// daemon/watch/tree_walk.h -- the regular files below a directory.
//
// Walks by descriptors (openat, no symbolic link is followed), so a directory that is swapped for a
// link while the walk runs cannot lead it out of the tree. Temporary names are left out
// (pipeline/drop/drop_names.h), files and directories alike. Depth is bounded: max_walk_depth; so
// are paths: each takes memory in the queue, in the watcher and in the catalog.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "daemon/watch/file_stamp.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

inline constexpr int max_walk_depth = 16;
inline constexpr std::size_t most_path_bytes = 1024;  // and a path is shorter
inline constexpr int entries_a_step = 128;

struct WalkVisitor {
    // Called before the directory's entries are read, so that a watch set here misses nothing.
    std::function<void(const std::filesystem::path&)> directory;
    std::function<void(const std::filesystem::path&, const FileStamp&)> file;
    // A directory below the root that cannot be read, or lies too deep; one line. The walk goes on.
    std::function<void(const std::string&)> problem;
    // What is neither file nor directory: a link, a FIFO, a device. May be empty.
    std::function<void(const std::filesystem::path&, mode_t mode)> other = {};
    // Beside `problem`: the system has no descriptors or no memory for it now. May be empty.
    std::function<void()> unseen = {};
    // Called after so many entries, for whoever has other things to do meanwhile. May be empty.
    std::function<void()> step = {};
};

// Fails (not_found, permission, io) when the root itself cannot be read. `depth`: of the root below
// the directory from which depth counts; one of depth 0 may be a link itself.
[[nodiscard]] Status walk(const std::filesystem::path& root, const WalkVisitor& visitor,
                          int depth = 0);

}  // namespace stormcellar::daemon
