// cache/pins.h -- pins grids that must stay, and evicts other grids.
//
// A pin is an empty file beside the grid, X.scg.pin, so any process may set one and it outlives all
// processes. The pin belongs to the name: a grid that is replaced stays pinned. Pinning and
// evicting hold the lock of the day's directory (flock, which the system releases when its holder
// dies). So a grid whose pin was set is never evicted: either the pin is set in time, or its setter
// learns that the grid is gone.
//
// Threads   Any thread of any process.
// Errors    Messages name the path.
#pragma once

#include <filesystem>
#include <string_view>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cache {

inline constexpr std::string_view pin_extension = ".pin";
[[nodiscard]] bool is_pinned(const std::filesystem::path& grid);

// Pins a grid. Errors: not_found if there is no grid. On success the pin survives a power cut.
// Pinning a pinned grid is not an error.
[[nodiscard]] Status pin_grid(FileSystem& file_system, const std::filesystem::path& grid);
// Removes a pin, and returns true if there was one. The grid need not exist.
[[nodiscard]] Result<bool> unpin_grid(FileSystem& file_system, const std::filesystem::path& grid);

enum class Evicted { gone, pinned, missing };
// Unlinks the file of a grid that is not pinned. A reader that has it open keeps its bytes; the
// space is freed when the last reader closes it. Until the directory is synced, the name may come
// back after a power cut.
[[nodiscard]] Result<Evicted> evict_grid(FileSystem& file_system,
                                         const std::filesystem::path& grid);

// Removes the directory of a day, then those of its moment and its domain, if they are empty.
void remove_empty_directories(const std::filesystem::path& day);

}  // namespace stormcellar::cache
