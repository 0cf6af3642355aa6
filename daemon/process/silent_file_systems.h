// daemon/process/silent_file_systems.h -- where directories change and inotify does not say so.
//
// The kernel tells of what passes through this machine. What other machines write to a file system
// that they share, or a program behind FUSE, it does not see, so such directories must be polled.
// Not told either: what is written to the layers of an overlay, past the overlay itself. That
// cannot be seen by the type, since most overlays are written to directly; rescans find it.
// Source of the numbers: statfs(2), linux/magic.h, and the headers of the projects that are named.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace stormcellar::daemon {

// Its name, by the type that statfs(2) gives; none for a file system whose changes are told.
[[nodiscard]] std::optional<std::string_view> silent_file_system(std::uint32_t type);
// The same of the one that a directory lies on; none where it cannot be asked.
[[nodiscard]] std::optional<std::string_view> silent_file_system_of(
    const std::filesystem::path& directory);

}  // namespace stormcellar::daemon
