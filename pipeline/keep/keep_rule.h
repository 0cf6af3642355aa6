// pipeline/keep/keep_rule.h -- which grids of a volume in the cache another grid replaces.
//
// Inside the pipeline room only. Thread contract: functions without state; the caller sees to it
// that one thread at a time works on a grid file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// The first words of the note in a living grid.
inline constexpr std::string_view living_note = "living: ";

// Why the new grid must not replace the grid at the path: that grid is of a complete volume and the
// new one is not, its file is newer, or its volume has ended and the new grid is a living one. The
// grid of an ended volume always replaces a living grid. Returns none if the new grid may replace
// it; it always may if the grid is damaged, missing or of another shape.
[[nodiscard]] std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                                        const cache::GridDescription& made);

// A radar begins no more volumes than this within an hour: the fastest pattern takes three minutes.
inline constexpr std::size_t most_volumes_an_hour = 120;
// If the cache holds more grids within half an hour of this one, removes the grid that was written
// longest ago, so that files which claim to be of one station push out little of the history of
// others. Pinned grids and this one stay.
void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time);

// Removes grids of the same volume that have another time: a volume of chunks has the time of its
// first radial until the chunk with its header comes. A volume without a header removes nothing,
// because its beginning may have been deleted since. The source of both grids must have the name of
// a chunk (stormcellar/level2/chunk_name.h). Pinned grids stay, and so does a grid that cannot be
// read or removed.
void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file);

}  // namespace stormcellar::pipeline
