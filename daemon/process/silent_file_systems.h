// daemon/process/silent_file_systems.h -- lists the file systems whose directories can change
// without inotify events ("silent" file systems).
//
// The kernel reports changes that this machine makes. It does not see other machines' writes to a
// shared file system, or changes made by a program behind FUSE, so such directories must be polled.
// If a file is written directly into a layer of an overlay, below the mount, the kernel does not
// report that either. But an overlay does not count as silent, because most programs write to its
// mount; rescans find files that are written into a layer.
//
// Threads   Pure: may be called from any thread.
// Source    statfs(2), linux/magic.h, and the headers of the projects in the table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace stormcellar::daemon {

// Returns the name of the silent file system that has this type in statfs(2). Returns none if the
// type is not known to be silent.
[[nodiscard]] std::optional<std::string_view> silent_file_system(std::uint32_t type);
// Returns the name of the directory's file system if it is silent. Returns none if it is not known
// to be silent, or if statfs(2) fails.
[[nodiscard]] std::optional<std::string_view> silent_file_system_of(
    const std::filesystem::path& directory);

}  // namespace stormcellar::daemon
