// base/beneath.h -- reading what lies below a directory, and nothing else, whatever others do to
// that directory meanwhile.
//
// A path is opened part by part from `root` down, and no part below root may be a symbolic link: a
// directory or file that is replaced by a link while we look leads nowhere. The root itself may be
// reached through links; mounts below it are followed. Nothing blocks, and only regular files are
// opened for reading. An empty root: the path's directories may be anywhere, and links; the file
// itself may not be a link.
// Errors: not_found (nothing there, a directory that is none or a link, a path outside of root),
// not_a_file (what it is instead is said), permission, io; unsupported for more than `limit` bytes.
// Messages begin with the path.
// Thread contract: functions are pure.
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

// What stands there; a symbolic link is not followed.
[[nodiscard]] Result<struct stat> look_beneath(const std::filesystem::path& root,
                                               const std::filesystem::path& path);
// A descriptor of a regular file, for reading; whoever asks closes it.
[[nodiscard]] Result<int> open_beneath(const std::filesystem::path& root,
                                       const std::filesystem::path& path);
[[nodiscard]] Result<std::vector<std::byte>> read_beneath(const std::filesystem::path& root,
                                                          const std::filesystem::path& path,
                                                          std::uint64_t limit = default_read_limit);
// The names in a directory, but for "." and "..", in no order.
[[nodiscard]] Result<std::vector<std::string>> names_beneath(
    const std::filesystem::path& root, const std::filesystem::path& directory);

// "a symbolic link", "a FIFO", "a device" and so on.
[[nodiscard]] std::string_view kind_of_file(mode_t mode);

}  // namespace stormcellar
