// daemon/process/silent_file_systems.h -- file systems whose directories can change without inotify
// events.
//
// The kernel reports changes made on this machine. It does not see writes of other machines to a
// shared file system, or changes made by a program behind FUSE, so such directories must be polled.
// The kernel also does not report files that are written directly into a layer of an overlay, below
// the mount. An overlay does not count as silent here, since most writers use its mount; rescans
// find the other files.
//
// Threads   Pure: may be called from any thread.
// Source    statfs(2), linux/magic.h, and the headers of the projects in the table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace stormcellar::daemon {

// Returns the name of a silent file system by its type from statfs(2); none if the file system is
// not known to be silent.
[[nodiscard]] std::optional<std::string_view> silent_file_system(std::uint32_t type);
// Returns the name of the file system of a directory if that file system is silent; none if it is
// not known to be silent, or if statfs(2) fails.
[[nodiscard]] std::optional<std::string_view> silent_file_system_of(
    const std::filesystem::path& directory);

}  // namespace stormcellar::daemon
