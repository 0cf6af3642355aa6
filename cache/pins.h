// cache/pins.h -- pins grids, and evicts grids that are not pinned.
//
// A pin is an empty file beside the grid, X.scg.pin. Any process may set a pin, and the pin
// outlives the process. The pin belongs to the grid's name, so a grid that is replaced stays
// pinned. Pinning and evicting lock the directory of the day with flock. The system releases the
// lock when its holder dies. If pin_grid() gets the lock first, evict_grid() does not evict the
// grid; if evict_grid() gets the lock first, pin_grid() returns not_found.
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

// Pins a grid. Does nothing if the grid is already pinned. On success the pin survives a power cut.
// Errors: not_found if there is no grid.
[[nodiscard]] Status pin_grid(FileSystem& file_system, const std::filesystem::path& grid);
// Removes a pin, and returns true if there was one. The grid need not exist.
[[nodiscard]] Result<bool> unpin_grid(FileSystem& file_system, const std::filesystem::path& grid);

enum class Evicted { gone, pinned, missing };
// Removes the file of a grid unless the grid is pinned, and returns what happened. A reader that
// has the file open can still read it; the space is freed when the last reader closes it. Until the
// directory is synced, a power cut may bring the name back.
[[nodiscard]] Result<Evicted> evict_grid(FileSystem& file_system,
                                         const std::filesystem::path& grid);

// Removes the directory of a day if it is empty. Then does the same for the directory of its
// moment, and then for the directory of its domain.
void remove_empty_directories(const std::filesystem::path& day);

}  // namespace stormcellar::cache
