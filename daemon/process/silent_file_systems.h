// daemon/process/silent_file_systems.h -- file systems whose changes inotify does not report.
//
// The kernel reports changes that pass through this machine. It does not see what other machines
// write to a shared file system, or what a program behind FUSE writes, so such directories must be
// polled. It also does not report what is written to the layers of an overlay, past the overlay
// itself. The type does not reveal that, because most overlays are written to directly; rescans
// find it. Source of the numbers: statfs(2), linux/magic.h, and the headers of the projects that
// are named. Thread contract: functions without state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace stormcellar::daemon {

// The name of the file system with this type of statfs(2); none if its changes are reported.
[[nodiscard]] std::optional<std::string_view> silent_file_system(std::uint32_t type);
// The same for the file system of a directory; none if the type cannot be read.
[[nodiscard]] std::optional<std::string_view> silent_file_system_of(
    const std::filesystem::path& directory);

}  // namespace stormcellar::daemon
