// daemon/process/silent_file_systems.h -- file systems whose directories can change without inotify
// events.
//
// The kernel reports changes made on this machine. It does not see what other machines write to a
// shared file system, or what a program behind FUSE does, so such directories must be polled. It
// also does not report writes to the layers of an overlay that bypass the overlay. The type does
// not show this, since most overlays are written to directly; rescans find such files.
//
// Threads   Pure: may be called from any thread.
// Source    statfs(2), linux/magic.h, and the headers of the projects that are named in the table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace stormcellar::daemon {

// Returns the name of a silent file system from the type that statfs(2) gives; none if changes are
// reported.
[[nodiscard]] std::optional<std::string_view> silent_file_system(std::uint32_t type);
// Returns the same for the file system of a directory; none if it cannot be found out.
[[nodiscard]] std::optional<std::string_view> silent_file_system_of(
    const std::filesystem::path& directory);

}  // namespace stormcellar::daemon
