// base/beneath.h -- reads files below a directory, and never anything outside it, even while other
// programs change that directory.
//
// A path is opened part by part from `root` down. No part below the root may be a symbolic link, so
// a program that replaces a directory or a file by a link gains nothing. The root itself may be
// reached through links. A directory below the root may be a mount point. Only regular files and
// directories are read, and opening them never waits for another program, as opening a FIFO would.
// With an empty root, the directories of the path may be anywhere and may be links, but a file may
// not be a link.
//
// Threads   Functions without state, which read files.
// Errors    not_found if nothing is at the path, if the path is outside the root, or if a directory
//           of the path is a link or not a directory; not_a_file if the file is not regular (the
//           message says what it is); unsupported if the file has more than `limit` bytes;
//           permission, io. Messages begin with the path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/stat.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

// Returns the facts of the file, directory or link at the path. Does not follow a symbolic link.
[[nodiscard]] Result<struct stat> look_beneath(const std::filesystem::path& root,
                                               const std::filesystem::path& path);
// Returns a descriptor of a regular file for reading. The caller must close it.
[[nodiscard]] Result<int> open_beneath(const std::filesystem::path& root,
                                       const std::filesystem::path& path);
// Reads a regular file.
[[nodiscard]] Result<std::vector<std::byte>> read_beneath(const std::filesystem::path& root,
                                                          const std::filesystem::path& path,
                                                          std::uint64_t limit = default_read_limit);
// Returns the names in a directory, in no order, without "." and "..".
[[nodiscard]] Result<std::vector<std::string>> names_beneath(
    const std::filesystem::path& root, const std::filesystem::path& directory);

// Returns "a symbolic link", "a FIFO", "a device" and so on.
[[nodiscard]] std::string_view kind_of_file(mode_t mode);

}  // namespace stormcellar
